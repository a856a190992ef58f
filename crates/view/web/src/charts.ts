// Charts of channels in step with the time, and the energy ledger as a stacked picture.

import uPlot from "uplot";
import type { Channel, Run } from "./data";
import { tickLabels } from "./text";

const HEIGHT = 170;
/** Charts that are open at the beginning. */
const FIRST = 2;
const STORED = ["kinetic", "axial", "bending", "contact", "springs"];
const LOST = ["contact_dissipated", "friction_dissipated", "damping_dissipated"];
const COLOURS = ["--c1", "--c2", "--c3", "--c4", "--c5", "--c6", "--c7", "--c8"];

interface Series {
  label: string;
  values: ArrayLike<number>;
  /** What the legend shows, where it is not what is drawn. */
  own?: ArrayLike<number>;
  dashed?: boolean;
  fill?: boolean;
}

/** The charts below the mechanism. */
export class Charts {
  private panels: { plot: uPlot; cursor: HTMLElement; element: HTMLElement }[] = [];
  private chosen: Set<string>;
  private ledger: boolean;
  private t = 0;
  /** The part of the time that is shown, if it is not all of it. */
  private part: { min: number; max: number } | null = null;

  constructor(
    private root: HTMLElement,
    picker: HTMLDetailsElement,
    private run: Run,
    private ghost: Run | undefined,
    private seek: (t: number) => void,
  ) {
    this.chosen = new Set(atFirst(run));
    this.ledger = terms(run).length > 0;
    this.fillPicker(picker);
    this.draw();
    new ResizeObserver(() => this.resize()).observe(root);
  }

  /** Moves the lines that show the time. */
  update(t: number): void {
    this.t = t;
    const { times } = this.run;
    let [low, high] = [0, times.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= t) low = middle;
      else high = middle - 1;
    }
    // the nearest row
    if (low + 1 < times.length && times[low + 1] - t < t - times[low]) low++;
    for (const { plot, cursor } of this.panels) {
      plot.setLegend({ idx: low });
      const x = plot.valToPos(t, "x");
      cursor.style.display = x >= 0 && x <= plot.over.clientWidth ? "" : "none";
      cursor.style.transform = `translateX(${x}px)`;
    }
  }

  /** Draws all charts anew, with the colours of the page. */
  draw(): void {
    this.panels.forEach(({ plot, element }) => (plot.destroy(), element.remove()));
    this.panels = [];
    const shown = this.run.channels.filter((c) => this.chosen.has(c.name));
    for (const [unit, channels] of byUnit(shown)) {
      const series = channels.flatMap((c) => [{ label: c.name, values: c.values }, ...this.shadow(c)]);
      this.panel(channels.map((c) => c.name).join(", "), unit, series);
    }
    if (this.ledger) this.panel("Energy: stored and dissipated, stacked; line: supplied", "J", ledger(this.run), 0);
    if (this.part) this.panels[0]?.plot.setScale("x", this.part);
    this.update(this.t);
  }

  /** The same channel of the ghost, at the times of the run. */
  private shadow(channel: Channel): Series[] {
    const other = this.ghost?.channels.find((c) => c.name === channel.name);
    if (!other) return [];
    const { times } = this.ghost!;
    let i = 0;
    const values = Float64Array.from(this.run.times, (t) => {
      while (i + 2 < times.length && times[i + 1] <= t) i++;
      const share = (t - times[i]) / (times[i + 1] - times[i]);
      return share > 1 ? NaN : other.values[i] + share * (other.values[i + 1] - other.values[i]);
    });
    return [{ label: `${channel.name} (ghost)`, values, dashed: true }];
  }

  private panel(title: string, unit: string, series: Series[], least?: number): void {
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const element = document.createElement("figure");
    element.setAttribute("role", "img");
    element.setAttribute("aria-label", `${title} [${unit}] over time [s]`);
    this.root.append(element);
    const axis = { stroke: colour("--ink"), grid: { stroke: colour("--grid"), width: 1 }, ticks: { stroke: colour("--grid"), width: 1 } };
    let next = 0;
    const plot = new uPlot(
      {
        width: Math.max(this.root.clientWidth, 200),
        height: HEIGHT,
        scales: { x: { time: false }, y: least === undefined ? {} : { range: (_, min, max) => [Math.min(least, min), 1.05 * max] } },
        axes: [
          { ...axis, label: "t", labelSize: 16, size: 32, values: (_, ticks) => tickLabels(ticks, this.run.is_static ? "1" : "s") },
          { ...axis, size: 82, space: 26, values: (_, ticks) => tickLabels(ticks, unit) },
        ],
        series: [
          { label: "t", value: (_, v) => (v == null ? "–" : `${v.toPrecision(6)} s`) },
          ...series.map((s) => {
            const c = colour(s.dashed ? "--soft" : COLOURS[next++ % COLOURS.length]);
            return {
              label: s.label,
              stroke: c,
              width: 1.2,
              dash: s.dashed ? [5, 4] : undefined,
              fill: s.fill ? `color-mix(in srgb, ${c} 65%, ${colour("--panel")})` : undefined,
              pxAlign: 0,
              points: { show: false },
              value: (_: uPlot, v: number | null, __: number, i: number | null) => (v == null ? "–" : written(s.own && i != null ? s.own[i] : v, unit)),
            };
          }),
        ],
        cursor: { drag: { x: true, y: false }, focus: { prox: 16 } },
        hooks: { setScale: [(u, key) => key === "x" && this.zoomed(u)] },
      },
      [this.run.times, ...series.map((s) => s.values)] as uPlot.AlignedData,
      element,
    );
    const cursor = document.createElement("div");
    cursor.className = "now";
    plot.over.append(cursor);
    plot.over.addEventListener("click", (event) => {
      if (plot.select.width === 0) this.seek(plot.posToVal(event.offsetX, "x"));
    });
    this.panels.push({ plot, cursor, element });
  }

  /** All charts show the same part of the time. */
  private zoomed(from: uPlot): void {
    const { min, max } = from.scales.x;
    if (min == null || max == null) return;
    const { times } = this.run;
    this.part = min > times[0] || max < times[times.length - 1] ? { min, max } : null;
    for (const { plot } of this.panels) {
      if (plot !== from && (plot.scales.x.min !== min || plot.scales.x.max !== max)) plot.setScale("x", { min, max });
    }
    this.update(this.t);
  }

  private resize(): void {
    const width = this.root.clientWidth;
    if (width > 0) this.panels.forEach(({ plot }) => plot.setSize({ width, height: HEIGHT }));
    this.update(this.t);
  }

  private fillPicker(picker: HTMLDetailsElement): void {
    const [search, list] = [picker.querySelector("input")!, picker.querySelector("div")!];
    const option = (text: string, on: boolean, change: (on: boolean) => void) => {
      const label = document.createElement("label");
      const box = document.createElement("input");
      box.type = "checkbox";
      box.checked = on;
      box.addEventListener("change", () => (change(box.checked), this.draw()));
      label.append(box, ` ${text}`);
      list.append(label);
    };
    if (this.ledger) option("energy ledger, stacked", true, (on) => (this.ledger = on));
    for (const { name, unit } of this.run.channels) {
      const change = (on: boolean) => void (on ? this.chosen.add(name) : this.chosen.delete(name));
      option(unit === "1" ? name : `${name} [${unit}]`, this.chosen.has(name), change);
    }
    search.addEventListener("input", () => {
      for (const label of list.children as Iterable<HTMLElement> & HTMLCollection) {
        label.hidden = !label.textContent!.toLowerCase().includes(search.value.toLowerCase());
      }
    });
  }
}

/** A value with its unit. */
function written(value: number, unit: string): string {
  return unit === "1" ? value.toPrecision(6) : `${value.toPrecision(6)} ${unit}`;
}

/** Channels that are shown at the beginning: errors of the driven body and forces of joints, or else the first that vary. */
function atFirst(run: Run): string[] {
  const names = run.channels.filter((c) => c.values.some((x) => x !== c.values[0])).map((c) => c.name);
  const errors = names.filter((n) => n === "error.x" || n === "error.y");
  const forces = names.filter((n) => n.endsWith(".force"));
  const others = names.filter((n) => !n.startsWith("energy."));
  const groups = [errors, forces.slice(0, 1), others.slice(0, 2)].filter((g) => g.length > 0);
  return groups.slice(0, FIRST).flat();
}

function byUnit(channels: Channel[]): Map<string, Channel[]> {
  const units = new Map<string, Channel[]>();
  for (const c of channels) units.set(c.unit, [...(units.get(c.unit) ?? []), c]);
  return units;
}

/** Terms of the ledger that are recorded and not zero throughout. */
function terms(run: Run): { name: string; values: Float64Array }[] {
  const get = (name: string) => run.channels.find((c) => c.name === `energy.${name}`)?.values;
  if (!get("kinetic") || !get("work")) return [];
  const gravity = get("gravity");
  const lowest = gravity ? gravity.reduce((least, x) => Math.min(least, x), Infinity) : 0;
  return ["gravity", ...STORED, ...LOST].flatMap((name) => {
    const values = get(name);
    if (!values?.some((x) => x !== 0)) return [];
    return [{ name, values: Float64Array.from(values, (x) => (name === "gravity" ? x - lowest : x)) }];
  });
}

/** Cumulative sums, the largest first so that the others are painted over it, and the energy supplied. */
function ledger(run: Run): Series[] {
  const sum = new Float64Array(run.times.length);
  const stacked = terms(run).map(({ name, values }) => {
    values.forEach((x, i) => (sum[i] += x));
    return { label: name.replaceAll("_", " "), values: Float64Array.from(sum), own: values, fill: true };
  });
  const work = run.channels.find((c) => c.name === "energy.work")!.values;
  const supplied = Float64Array.from(work, (w) => sum[0] - work[0] + w);
  return [...stacked.reverse(), { label: "supplied: energy at the start + work", values: supplied }];
}
