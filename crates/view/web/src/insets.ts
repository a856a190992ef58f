// One inset a loose joint: the journal in its bearing with the play magnified, the orbit of its centre, the contact force.

import type { Clearance, Joint, Run } from "./data";
import { arrow, WEAKEST } from "./mechanism";
import { angleAt } from "./pose";
import { add, set } from "./svg";
import { quantity } from "./text";

/** Radii of the bearing and of the play in the picture; that of the journal is the difference. */
const BEARING = 44;
const PLAY = 22;
const LONGEST_ARROW = 30;
/** Rows of the orbit that are shown. */
const ORBIT_ROWS = 600;

type Updater = (t: number) => void;

/** The insets of a run; `ghost` is drawn where its joint of the same name is loose, too. */
export function insets(parent: HTMLElement, run: Run, ghost: Run | undefined): Updater {
  const loose = run.joints.filter((joint) => joint.clearance);
  parent.hidden = loose.length === 0;
  const updaters = loose.map((joint) => {
    const other = ghost?.joints.find((j) => j.name === joint.name)?.clearance ?? null;
    return inset(parent, run, joint, joint.clearance!, other);
  });
  return (t) => updaters.forEach((update) => update(t));
}

function inset(parent: HTMLElement, run: Run, joint: Joint, loose: Clearance, ghost: Clearance | null): Updater {
  const figure = document.createElement("figure");
  parent.append(figure);
  const svg = add(figure, "svg", { viewBox: "-60 -60 120 120", role: "img", "data-inset": joint.name });
  const title = add(svg, "title");
  const plane = add(svg, "g", { transform: "scale(1 -1)" });
  const slide = typeof joint.glyph === "object" ? joint.glyph.slide : null;
  const walls = slide === null ? null : add(plane, "g", { class: "bearing" });
  if (walls) {
    for (const y of [-BEARING, BEARING]) add(walls, "line", { x1: -58, x2: 58, y1: y, y2: y });
  } else {
    add(plane, "circle", { class: "bearing", r: BEARING });
  }
  add(plane, "circle", { class: "play", r: PLAY });
  const orbit = add(plane, "polyline", { class: "orbit" });
  const shadow = ghost && add(plane, "circle", { class: "journal shadow", r: BEARING - PLAY });
  const journal = add(plane, "circle", { class: "journal", r: BEARING - PLAY });
  const centre = add(plane, "circle", { class: "centre", r: 2 });
  const force = add(plane, "path", { class: "arrow" });
  const caption = document.createElement("figcaption");
  figure.append(caption);

  const { clearance, eccentricity } = loose;
  const scale = PLAY / clearance;
  const [ex, ey] = eccentricity.columns;
  return (t) => {
    const [x, y] = eccentricity.at(t);
    const [cx, cy] = [scale * x, scale * y];
    set(journal, { cx, cy });
    set(centre, { cx, cy });
    if (shadow) {
      const [gx, gy] = ghost.eccentricity.at(t);
      set(shadow, { cx: (PLAY / ghost.clearance) * gx, cy: (PLAY / ghost.clearance) * gy });
    }
    if (walls) {
      const angle = angleAt(run, joint.ends[0], t) + slide!;
      set(walls, { transform: `rotate(${(angle * 180) / Math.PI})` });
    }
    // between walls that turn, earlier positions stand nowhere
    if (!walls) {
      const last = eccentricity.index(t);
      const points: string[] = [];
      for (let i = Math.max(0, last - ORBIT_ROWS); i <= last; i++) points.push(`${scale * ex[i]},${scale * ey[i]}`);
      set(orbit, { points: `${points.join(" ")} ${cx},${cy}` });
    }
    const [fx, fy] = loose.force.at(t);
    // forces are stored to a thousandth of the largest
    const share = loose.strongest > 0 ? Math.hypot(fx, fy) / loose.strongest : 0;
    const newtons = share < WEAKEST ? 0 : Math.hypot(fx, fy);
    // from the contact point, where the bearing pushes the journal
    const angle = Math.atan2(fy, fx);
    const contact: [number, number] = [cx - (BEARING - PLAY) * Math.cos(angle), cy - (BEARING - PLAY) * Math.sin(angle)];
    const length = share < WEAKEST ? 0 : LONGEST_ARROW * (1 - Math.log(share) / Math.log(WEAKEST));
    set(force, { d: length > 0 ? arrow(contact, angle, length, 3) : "" });
    const part = Math.hypot(x, y) / clearance;
    caption.textContent = `${joint.name}: e = ${quantity(part * clearance, "m")}\n${part.toFixed(2)} c, ${quantity(newtons, "N")}`;
    title.textContent = `Joint ${joint.name}, play ${quantity(clearance, "m")} magnified: eccentricity ${part.toFixed(2)} of the clearance, contact force ${quantity(newtons, "N")}`;
  };
}
