// Where bodies and their points are at a time.

import type { Body, End, Run } from "./data";

export type Vector = [x: number, y: number];

/** Position and slope of every node of a flexible link, its deviations from the straight link magnified. */
export function nodes(body: Body, t: number, magnification: number): { at: Vector; slope: Vector }[] {
  const shape = body.shape as { beam: { elements: number; length: number } };
  const { elements, length } = shape.beam;
  const [x, y, theta, chord] = body.pose!.at(t);
  const deviations = body.deformation!.at(t);
  const [c, s] = [Math.cos(theta), Math.sin(theta)];
  const turned = (u: number, w: number): Vector => [c * u - s * w, s * u + c * w];
  return Array.from({ length: elements + 1 }, (_, k) => {
    const [u, w, su, sw] = deviations.slice(4 * k, 4 * k + 4).map((d) => magnification * d);
    const [dx, dy] = turned((chord * k) / elements + u, w);
    return { at: [x + dx, y + dy], slope: turned(chord / length + su, sw) };
  });
}

/** A point of a body. */
export function pointAt(run: Run, [b, p]: End, t: number, magnification: number): Vector {
  const body = run.bodies[b];
  if (p < 0) return body.pose!.at(t).slice(0, 2) as Vector;
  const point = body.points[p];
  if (point.node !== null) return nodes(body, t, magnification)[point.node].at;
  if (!body.pose) return point.at;
  const [x, y, theta] = body.pose.at(t);
  const [c, s] = [Math.cos(theta), Math.sin(theta)];
  const [px, py] = point.at;
  return [x + c * px - s * py, y + s * px + c * py];
}

/** The direction of a body at a point: of a flexible link that of its slope there, of the ground zero. */
export function angleAt(run: Run, [b, p]: End, t: number): number {
  const body = run.bodies[b];
  const node = body.points[p].node;
  if (node === null) return body.pose ? body.pose.at(t)[2] : 0;
  const [x, y] = nodes(body, t, 1)[node].slope;
  return Math.atan2(y, x);
}
