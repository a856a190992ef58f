// The page: reads the runs, draws the first with the second as its ghost, and lets time go on.

import { Charts } from "./charts";
import { type End, load, type Run } from "./data";
import { insets } from "./insets";
import { Mechanism, type Options } from "./mechanism";
import { pointAt } from "./pose";
import { Plane } from "./plane";
import { add } from "./svg";

/** Seconds that a run takes at the first speed. */
const FIRST_SPEED = 12;
/** The largest magnification bends a link by this part of its length. */
const LARGEST_BEND = 0.5;

const find = <T extends Element>(id: string) => document.getElementById(id) as unknown as T;

function header(run: Run, ghost: Run | undefined): void {
  document.title = `${run.title} – Looselink`;
  find("title").textContent = run.title;
  const parts = [run.method, run.folder, ...run.overrides];
  if (ghost) parts.push(`ghost: ${ghost.title}, ${ghost.folder}`);
  find("method").textContent = parts.join(" · ");
  const ended = [run, ghost].flatMap((r, i) => {
    if (!r || r.status === "complete") return [];
    return [`the ${i === 0 ? "run" : "ghost"} is ${r.status}${r.error ? `: ${r.error}` : ""}`];
  });
  const ghostly = (ghost?.warnings ?? []).map((w) => `ghost: ${w}`);
  const all = [...ended, ...run.warnings, ...ghostly];
  const box = find<HTMLDetailsElement>("warnings");
  box.hidden = all.length === 0;
  const count = (warnings: string[], of: string) => (warnings.length ? [`${warnings.length} warning${warnings.length === 1 ? "" : "s"} of the ${of}`] : []);
  box.querySelector("summary")!.textContent = [...ended, ...count(run.warnings, "run"), ...count(ghostly, "ghost")].join("; ");
  box.querySelector("ul")!.replaceChildren(
    ...all.map((warning) => Object.assign(document.createElement("li"), { textContent: warning })),
  );
}

/** Buttons and sliders beside the mechanism. */
function tools(run: Run, options: Options, plane: Plane, changed: () => void): void {
  const root = find<HTMLElement>("tools");
  const labelled = (text: string, control: HTMLElement) => {
    const label = document.createElement("label");
    label.append(`${text} `, control);
    root.append(label);
  };
  const box = (text: string, on: boolean, change: (on: boolean) => void) => {
    const input = Object.assign(document.createElement("input"), { type: "checkbox", checked: on });
    input.addEventListener("change", () => (change(input.checked), changed()));
    labelled(text, input);
  };
  if (run.joints.some((j) => j.clearance)) box("Forces", options.forces, (on) => (options.forces = on));
  box("Names", options.names, (on) => (options.names = on));
  const select = document.createElement("select");
  const points = (b: number) => run.bodies[b].points.map((_, p): End => [b, p]);
  const ends = run.bodies.flatMap((body, b) => (body.pose ? [...(b === run.driven ? [[b, -1] as End] : []), ...points(b)] : []));
  const name = ([b, p]: End) => (p < 0 ? run.bodies[b].name : `${run.bodies[b].name}.${run.bodies[b].points[p].name}`);
  select.append(new Option("none"), ...ends.map((end) => new Option(name(end))));
  select.selectedIndex = options.trail ? 1 + ends.findIndex((end) => name(end) === name(options.trail!)) : 0;
  select.addEventListener("change", () => ((options.trail = ends[select.selectedIndex - 1] ?? null), changed()));
  labelled("Trail", select);
  const largest = largestMagnification(run);
  if (largest > 1) {
    const slider = Object.assign(document.createElement("input"), { type: "range", min: "0", max: String(Math.log10(largest)), step: "any", value: "0" });
    slider.setAttribute("aria-label", "Magnification of deformations");
    slider.id = "magnification";
    const text = document.createElement("output");
    const show = () => {
      options.magnification = 10 ** Number(slider.value);
      text.textContent = `× ${Number(options.magnification.toPrecision(2))}`;
    };
    slider.addEventListener("input", () => (show(), changed()));
    show();
    labelled("Deformation", slider);
    root.lastElementChild!.append(text);
  }
  const fit = Object.assign(document.createElement("button"), { type: "button", textContent: "Fit" });
  fit.addEventListener("click", () => plane.fit());
  const theme = Object.assign(document.createElement("button"), { type: "button", textContent: "Light / dark" });
  theme.id = "theme";
  root.append(fit, theme);
}

/** The magnification at which the link that bends most is bent by half its length; 1 if no link bends. */
function largestMagnification(run: Run): number {
  const bends = run.bodies.map(({ shape, deformation }) => {
    if (typeof shape !== "object" || !("beam" in shape) || !deformation) return 0;
    const across = deformation.columns.filter((_, i) => i % 4 === 1 || i % 4 === 3);
    // a slope at the end of a link moves its middle by about an eighth of the length
    const most = across.map((c, i) => c.reduce((m, x) => Math.max(m, Math.abs(x)), 0) / (i % 2 === 0 ? shape.beam.length : 8));
    return Math.max(...most);
  });
  const most = Math.max(0, ...bends);
  return most > 0 ? LARGEST_BEND / most : 1;
}

/** The point whose way is drawn at first: the driven body, or the point that gets around most. */
function firstTrail(run: Run): End | null {
  if (run.driven !== null) return [run.driven, -1];
  const duration = run.times[run.times.length - 1];
  let best: { end: End | null; way: number } = { end: null, way: 0 };
  run.bodies.forEach((body, b) => {
    if (!body.pose) return;
    body.points.forEach((_, p) => {
      const places = Array.from({ length: 60 }, (_, k) => pointAt(run, [b, p], (duration * k) / 59, 1));
      const extent = [0, 1].map((i) => Math.max(...places.map((x) => x[i])) - Math.min(...places.map((x) => x[i])));
      const way = Math.hypot(extent[0], extent[1]);
      if (way > best.way * 1.0001) best = { end: [b, p], way };
    });
  });
  return best.end;
}

async function main(): Promise<void> {
  const [run, ghost] = await load();
  const { times } = run;
  const [begin, end] = [times[0], times[times.length - 1]];
  header(run, ghost);
  const options: Options = { magnification: 1, pixel: 1, forces: true, names: false, trail: firstTrail(run) };

  const svg = find<SVGSVGElement>("mechanism");
  let ready = false;
  const plane: Plane = new Plane(svg, run.bounds, () => ready && show());
  const world = add(svg, "g", { id: "world", transform: "scale(1 -1)" });
  const pictures = [
    ...(ghost ? [new Mechanism(world, ghost, "ghost")] : []),
    new Mechanism(world, run, "run"),
  ];
  const updateInsets = insets(find("insets"), run, ghost);
  const slider = find<HTMLInputElement>("time");
  const play = find<HTMLButtonElement>("play");
  const clock = find<HTMLElement>("clock");
  let [t, playing] = [begin, false];

  const show = () => {
    options.pixel = plane.scale();
    for (const picture of pictures) picture.update(t, options);
    svg.querySelector(".ghost")?.classList.toggle("gone", t > ghost!.times[ghost!.times.length - 1]);
    updateInsets(t);
    charts.update(t);
    slider.value = String(t);
    const text = `t = ${t.toPrecision(5)}${run.is_static ? "" : " s"}`;
    clock.textContent = text;
    slider.setAttribute("aria-valuetext", text);
    svg.setAttribute("aria-label", `${run.title}: ${run.bodies.length} bodies, ${run.joints.length} joints at ${text}`);
  };
  const seek = (to: number) => {
    t = Math.min(Math.max(to, begin), end);
    show();
  };
  const charts = new Charts(find("panels"), find("picker"), run, ghost, seek);

  // time
  slider.min = String(begin);
  slider.max = String(end);
  slider.addEventListener("input", () => seek(Number(slider.value)));
  const speed = find<HTMLInputElement>("speed");
  const factor = () => 10 ** Number(speed.value);
  const showSpeed = () => (find("speed-text").textContent = `× ${Number(factor().toPrecision(2))}`);
  speed.value = String(Math.log10((end - begin) / FIRST_SPEED || 1));
  speed.addEventListener("input", showSpeed);
  showSpeed();
  let last = 0;
  const frame = (now: number) => {
    if (!playing) return;
    const next = t + ((now - last) / 1000) * factor();
    last = now;
    seek(next >= end ? begin : next);
    requestAnimationFrame(frame);
  };
  const toggle = (on = !playing) => {
    playing = on;
    play.classList.toggle("playing", on);
    play.setAttribute("aria-label", on ? "Pause" : "Play");
    last = performance.now();
    if (on) requestAnimationFrame(frame);
  };
  play.addEventListener("click", () => toggle());
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    const typing = target.matches("input[type=search], select");
    const moves = target.matches("input[type=range]") && /^(Arrow|Home|End)/.test(event.key);
    const presses = target.matches("input, button, summary") && event.key === " ";
    if (typing || moves || presses || event.ctrlKey || event.metaKey) return;
    const step = (end - begin) / (event.shiftKey ? 1000 : 100);
    const actions: Record<string, () => void> = {
      " ": () => toggle(),
      ArrowLeft: () => seek(t - step),
      ArrowRight: () => seek(t + step),
      Home: () => seek(begin),
      End: () => seek(end),
      "+": () => plane.zoom(0.8),
      "-": () => plane.zoom(1.25),
    };
    if (actions[event.key]) {
      event.preventDefault();
      actions[event.key]();
    }
  });

  tools(run, options, plane, show);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const theme = (value: string) => {
    document.documentElement.dataset.theme = value;
    charts.draw();
  };
  find("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  theme(dark.matches ? "dark" : "light");
  if (run.joints.some((j) => j.clearance)) {
    find("legend").textContent = "Arrows: force of the bearing on the journal. Their length is logarithmic, from a thousandth of the largest force on.";
  }
  ready = true;
  // loose pins lie where the start puts them; in mid-motion they are on their way
  const loose = run.joints.some((j) => j.clearance);
  seek(loose ? times[times.length >> 1] : begin);
  document.documentElement.dataset.ready = "yes";
}

main().catch((error: unknown) => {
  find("title").textContent = "This page cannot be shown";
  find("method").textContent = `${error}. It needs a browser of 2023 or later.`;
});
