// The mechanism: bodies, joints, springs and loads, contact forces, trails.

import type { Body, End, Joint, Run } from "./data";
import { angleAt, nodes, pointAt, type Vector } from "./pose";
import { add, set } from "./svg";

/** Sizes of symbols relative to the mechanism. */
const BAR = 0.026;
const RING = 0.014;
const SLOT = 0.12;
const ARROW = 0.22;
/** Contact forces below this part of the largest are not drawn; the length of arrows is logarithmic above it. */
export const WEAKEST = 1e-3;
/** A trail has this many points at most, with this angle between two of a body that turns [rad]. */
const TRAIL_POINTS = 4000;
const TRAIL_TURN = 0.05;
/** Symbols of joints grow with the picture up to this radius, and names have this size [pixels]. */
const LARGEST_RING = 11;
const LETTERS = 13;

export interface Options {
  magnification: number;
  /** Metres a pixel. */
  pixel: number;
  forces: boolean;
  names: boolean;
  trail: End | null;
}

type Updater = (t: number, options: Options) => void;

/** Draws a run, and moves it. */
export class Mechanism {
  private updaters: Updater[] = [];
  readonly size: number;
  private strongest: number;

  constructor(
    root: SVGGElement,
    private run: Run,
    kind: "run" | "ghost",
  ) {
    const [x0, y0, x1, y1] = run.bounds;
    this.size = Math.max(x1 - x0, y1 - y0) || 1;
    this.strongest = Math.max(0, ...run.joints.map((j) => j.clearance?.strongest ?? 0));
    const group = add(root, "g", { class: kind });
    if (kind === "run") {
      if (run.path.length > 0) add(group, "polyline", { class: "path", points: run.path.join(" ") });
      this.addTrail(group);
    }
    run.bodies.forEach((body, b) => this.addBody(group, body, b));
    run.forces.forEach((force) => this.addForce(group, force.ends));
    run.joints.forEach((joint) => this.addJoint(group, joint));
    if (kind === "run") {
      run.joints.forEach((joint) => this.addArrow(group, joint));
      run.bodies.forEach((body, b) => this.addName(group, body, b));
      run.joints.forEach((joint) => joint.clearance && this.addJointName(group, joint));
    }
  }

  update(t: number, options: Options): void {
    for (const update of this.updaters) update(t, options);
  }

  private addBody(parent: Element, body: Body, b: number): void {
    const { shape } = body;
    const label = { "data-body": body.name };
    if (shape === "ground") {
      body.points.forEach((p) => this.addSupport(parent, p.at));
      return;
    }
    if ("beam" in shape) {
      const path = add(parent, "path", { ...label, class: "beam", "stroke-width": 0.5 * BAR * this.size });
      this.updaters.push((t, options) => set(path, { d: curve(nodes(body, t, options.magnification), shape.beam) }));
      return;
    }
    const group = add(parent, "g", { ...label, class: `rigid tone${b % 3}` });
    if ("disc" in shape) {
      const slides = this.run.joints.some((j) => typeof j.glyph === "object" && j.ends[1][0] === b);
      // a square with the moment of inertia of the disc
      const half = (shape.disc * Math.sqrt(3)) / 2;
      if (slides) add(group, "rect", { class: "solid", x: -half, y: -half, width: 2 * half, height: 2 * half });
      else add(group, "circle", { class: "solid", r: shape.disc });
      if (!slides) add(group, "line", { class: "mark", x2: shape.disc });
      const far = body.points.filter((p) => Math.hypot(...p.at) > 1.01 * shape.disc);
      for (const { at } of far) add(group, "line", { x2: at[0], y2: at[1], "stroke-width": 0.4 * BAR * this.size });
    } else if (shape.hull.length > 1) {
      add(group, "polygon", { points: shape.hull.join(" "), "stroke-width": BAR * this.size });
    } else {
      const [x, y] = shape.hull[0] ?? [0, 0];
      add(group, "circle", { cx: x, cy: y, r: 0.8 * BAR * this.size });
    }
    this.updaters.push((t) => {
      const [x, y, theta] = body.pose!.at(t);
      set(group, { transform: `translate(${x} ${y}) rotate(${(theta * 180) / Math.PI})` });
    });
  }

  /** The triangle of a fixed point. */
  private addSupport(parent: Element, [x, y]: Vector): void {
    const w = 1.4 * BAR * this.size;
    add(parent, "path", { class: "support", d: `M${x} ${y}l${-w} ${-1.5 * w}h${2 * w}z` });
  }

  private addJoint(parent: Element, joint: Joint): void {
    const { run } = this;
    const r = RING * this.size * (joint.clearance ? 1.2 : 1);
    const [b, p] = joint.ends[0];
    const bearing = `${run.bodies[b].name}.${run.bodies[b].points[p].name}`;
    const kind = joint.clearance ? "joint loose" : "joint";
    const group = add(parent, "g", { class: kind, "data-joint": joint.name, "data-bearing": bearing });
    const at = (end: 0 | 1, t: number, options: Options) => pointAt(run, joint.ends[end], t, options.magnification);
    const { glyph } = joint;
    if (typeof glyph === "object") {
      const half = 0.5 * SLOT * this.size;
      const slot = add(group, "line", { class: "slot", x1: -half, x2: half, style: `stroke-width: ${2.4 * r}` });
      const block = add(group, "rect", { x: -1.6 * r, y: -r, width: 3.2 * r, height: 2 * r });
      this.updaters.push((t, options) => {
        const angle = angleAt(run, joint.ends[0], t) + glyph.slide;
        const place = (p: Vector) => `translate(${p}) rotate(${(angle * 180) / Math.PI})`;
        set(slot, { transform: place(at(0, t, options)) });
        set(block, { transform: place(at(1, t, options)) });
      });
    } else if (glyph === "rod") {
      const line = add(group, "line", { class: "rod", style: `stroke-width: ${0.3 * BAR * this.size}` });
      this.updaters.push((t, options) => {
        const [[x1, y1], [x2, y2]] = [at(0, t, options), at(1, t, options)];
        set(line, { x1, y1, x2, y2 });
      });
    } else {
      const symbol =
        glyph === "weld" ? add(group, "rect", { x: -r, y: -r, width: 2 * r, height: 2 * r }) : add(group, "circle", { r });
      if (joint.clearance) add(group, "circle", { class: "pin", r: 0.45 * r });
      this.updaters.push((t, options) => {
        const scale = Math.min(1, (LARGEST_RING * options.pixel) / r);
        set(group, { transform: `translate(${at(0, t, options)}) scale(${scale})` });
      });
      add(symbol, "title").textContent = joint.name;
    }
  }

  /** A spring between two points, or a mark where a load acts. */
  private addForce(parent: Element, ends: End[]): void {
    const { run, size } = this;
    if (ends.length === 0) return;
    if (ends.length < 2) {
      const mark = add(parent, "circle", { class: "load", r: 0.7 * RING * size });
      this.updaters.push((t, options) => {
        const [cx, cy] = pointAt(run, ends[0], t, options.magnification);
        set(mark, { cx, cy });
      });
      return;
    }
    const path = add(parent, "path", { class: "spring" });
    this.updaters.push((t, options) => {
      const [a, b] = ends.slice(0, 2).map((end) => pointAt(run, end, t, options.magnification));
      set(path, { d: Math.hypot(b[0] - a[0], b[1] - a[1]) > RING * size ? zigzag(a, b, 0.02 * size) : spiral(a, 2.2 * RING * size) });
    });
  }

  /** The force of the bearing on the journal. */
  private addArrow(parent: Element, joint: Joint): void {
    const { clearance } = joint;
    if (!clearance || this.strongest === 0) return;
    const path = add(parent, "path", { class: "arrow" });
    this.updaters.push((t, options) => {
      const [fx, fy] = clearance.force.at(t);
      const share = Math.hypot(fx, fy) / this.strongest;
      if (!options.forces || share < WEAKEST) return set(path, { d: "" });
      const length = ARROW * this.size * (1 - Math.log(share) / Math.log(WEAKEST));
      const from = pointAt(this.run, joint.ends[0], t, options.magnification);
      set(path, { d: arrow(from, Math.atan2(fy, fx), length, 0.012 * this.size) });
    });
  }

  private addName(parent: Element, body: Body, b: number): void {
    if (!body.pose || body.points.length === 0) return;
    const middle = (t: number, options: Options): Vector => {
      const points = body.points.map((_, p) => pointAt(this.run, [b, p], t, options.magnification));
      const mean = (i: 0 | 1) => points.reduce((sum, p) => sum + p[i], 0) / points.length;
      return [mean(0), mean(1)];
    };
    this.addText(parent, body.name, 0, middle, (options) => options.names);
  }

  /** The name of a loose joint, by which its inset is found. */
  private addJointName(parent: Element, joint: Joint): void {
    const at = (t: number, options: Options) => pointAt(this.run, joint.ends[0], t, options.magnification);
    this.addText(parent, joint.name, 1.2 * LETTERS, at, () => true);
  }

  /** A text of constant size, so many pixels above a point. */
  private addText(parent: Element, words: string, above: number, at: (t: number, options: Options) => Vector, shown: (options: Options) => boolean): void {
    const text = add(parent, "text", { class: "name" });
    text.textContent = words;
    this.updaters.push((t, options) => {
      text.style.display = shown(options) ? "" : "none";
      if (!shown(options)) return;
      const [x, y] = at(t, options);
      const { pixel } = options;
      set(text, { transform: `translate(${x} ${y + above * pixel}) scale(${pixel} ${-pixel})`, "font-size": LETTERS });
    });
  }

  /** The way of a point up to now. */
  private addTrail(parent: Element): void {
    const line = add(parent, "polyline", { class: "trail" });
    this.updaters.push((t, { trail, magnification }) => {
      const times = trail ? trailTimes(this.run.bodies[trail[0]], t, magnification) : [];
      set(line, { points: times.map((time) => pointAt(this.run, trail!, time, magnification)).join(" ") });
    });
  }
}

/** Times up to t at which a trail has a point, the latest first: stored poses, and between them where the body turns. */
function trailTimes({ pose, deformation }: Body, t: number, magnification: number): number[] {
  const { times, columns } = magnification > 1 && deformation ? deformation : pose!;
  const turns = columns === pose!.columns ? columns[2] : null;
  const found = [t];
  let i = (columns === pose!.columns ? pose! : deformation!).index(t);
  for (let later = t; i >= 0 && found.length < TRAIL_POINTS; later = times[i--]) {
    const end = Math.min(i + 1, times.length - 1);
    const turned = turns ? Math.abs(turns[end] - turns[i]) : 0;
    const parts = Math.max(1, Math.ceil(turned / TRAIL_TURN));
    for (let k = 1; k <= parts; k++) found.push(later + ((times[i] - later) * k) / parts);
  }
  return found;
}

/** The cubics of a flexible link, as Bezier curves: control points lie a third of an element along the slopes. */
function curve(at: { at: Vector; slope: Vector }[], beam: { elements: number; length: number }): string {
  const third = beam.length / beam.elements / 3;
  const parts = at.slice(1).map((node, k) => {
    const before = at[k];
    const a = before.at.map((x, i) => x + third * before.slope[i]);
    const b = node.at.map((x, i) => x - third * node.slope[i]);
    return `C${a} ${b} ${node.at}`;
  });
  return `M${at[0].at}${parts.join("")}`;
}

function zigzag(a: Vector, b: Vector, width: number): string {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy);
  const normal = [(-dy / length) * width, (dx / length) * width];
  const turns = 12;
  const points = Array.from({ length: turns }, (_, k) => {
    const share = 0.2 + (0.6 * k) / (turns - 1);
    const side = k === 0 || k === turns - 1 ? 0 : k % 2 ? 1 : -1;
    return [a[0] + share * dx + side * normal[0], a[1] + share * dy + side * normal[1]];
  });
  return `M${a}L${points.join(" ")} ${b}`;
}

function spiral([x, y]: Vector, radius: number): string {
  const points = Array.from({ length: 49 }, (_, k) => {
    const [angle, r] = [(k * Math.PI) / 12, (radius * (k + 12)) / 60];
    return [x + r * Math.cos(angle), y + r * Math.sin(angle)];
  });
  return `M${points.join("L")}`;
}

export function arrow([x, y]: Vector, angle: number, length: number, head: number): string {
  const tip: Vector = [x + length * Math.cos(angle), y + length * Math.sin(angle)];
  const side = (turn: number) => [tip[0] + head * 2 * Math.cos(angle + turn), tip[1] + head * 2 * Math.sin(angle + turn)];
  return `M${x} ${y}L${tip}M${side(2.7)}L${tip}L${side(-2.7)}`;
}
