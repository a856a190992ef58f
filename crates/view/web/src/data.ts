// The data of the page: arrays in one compressed block, and quantities over time.

export interface Packed {
  kind: "f64" | "f32" | "u32" | "u16";
  at: number;
  count: number;
}
interface PackedGroup {
  keys: Packed;
  tracks: { offset: number; scale: number; data: Packed }[];
}
export type Shape =
  | "ground"
  | { hull: [number, number][] }
  | { disc: number }
  | { beam: { elements: number; length: number } };
export type Glyph = "revolute" | "weld" | "rod" | { slide: number };
/** A point of a body; -1 is the origin of its frame. */
export type End = [body: number, point: number];
interface PackedRun {
  title: string;
  folder: string;
  method: string;
  status: string;
  error: string | null;
  overrides: string[];
  warnings: string[];
  is_static: boolean;
  times: Packed;
  bounds: [number, number, number, number];
  bodies: {
    name: string;
    points: { name: string; at: [number, number]; node: number | null }[];
    shape: Shape;
    pose: PackedGroup | null;
    deformation: PackedGroup | null;
  }[];
  joints: {
    name: string;
    ends: [End, End];
    glyph: Glyph;
    clearance: { clearance: number; eccentricity: PackedGroup; force: PackedGroup } | null;
  }[];
  forces: { name: string; ends: End[] }[];
  path: [number, number][];
  driven: number | null;
  channels: { name: string; unit: string; offset: number; data: Packed }[];
}

/** Quantities over time, linear between the rows that were kept. */
export class Group {
  private last = 0;
  constructor(
    readonly times: Float64Array,
    readonly columns: Float64Array[],
  ) {}

  /** Index of the kept row at or before t. */
  index(t: number): number {
    const { times } = this;
    let i = this.last;
    if (!(times[i] <= t && (i + 1 >= times.length || t < times[i + 1]))) {
      let low = 0;
      let high = times.length - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (times[middle] <= t) low = middle;
        else high = middle - 1;
      }
      i = low;
    }
    this.last = i;
    return i;
  }

  /** All quantities at t. */
  at(t: number): number[] {
    const i = this.index(t);
    const j = Math.min(i + 1, this.times.length - 1);
    const span = this.times[j] - this.times[i];
    const share = span > 0 ? Math.min(Math.max((t - this.times[i]) / span, 0), 1) : 0;
    return this.columns.map((x) => x[i] + share * (x[j] - x[i]));
  }
}

export interface Point {
  name: string;
  at: [number, number];
  node: number | null;
}
export interface Body {
  name: string;
  points: Point[];
  shape: Shape;
  pose: Group | null;
  deformation: Group | null;
}
export interface Clearance {
  clearance: number;
  eccentricity: Group;
  force: Group;
  /** Largest force [N]. */
  strongest: number;
}
export interface Joint {
  name: string;
  ends: [End, End];
  glyph: Glyph;
  clearance: Clearance | null;
}
export interface Channel {
  name: string;
  unit: string;
  values: Float64Array;
}
export type Run = Omit<PackedRun, "times" | "bodies" | "joints" | "channels"> & {
  times: Float64Array;
  bodies: Body[];
  joints: Joint[];
  channels: Channel[];
};

const ARRAYS = { f64: Float64Array, f32: Float32Array, u32: Uint32Array, u16: Uint16Array };

/** The runs of the page. */
export async function load(): Promise<Run[]> {
  const element = document.getElementById("data");
  const contents = JSON.parse(element!.textContent!) as { runs: PackedRun[]; pack: string };
  const compressed = Uint8Array.from(atob(contents.pack), (c) => c.charCodeAt(0));
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const buffer = await new Response(stream).arrayBuffer();
  const array = (p: Packed) => new ARRAYS[p.kind](buffer, p.at, p.count);
  return contents.runs.map((run) => {
    const times = array(run.times) as Float64Array;
    const group = (g: PackedGroup) =>
      new Group(
        Float64Array.from(array(g.keys), (row) => times[row]),
        g.tracks.map((t) => Float64Array.from(array(t.data), (x) => t.offset + t.scale * x)),
      );
    const optional = (g: PackedGroup | null) => g && group(g);
    return {
      ...run,
      times,
      bodies: run.bodies.map((b) => ({ ...b, pose: optional(b.pose), deformation: optional(b.deformation) })),
      joints: run.joints.map((j) => ({ ...j, clearance: j.clearance && loose(j.clearance, group) })),
      channels: run.channels.map((c) => ({
        name: c.name,
        unit: c.unit,
        values: Float64Array.from(array(c.data), (x) => c.offset + x),
      })),
    };
  });
}

function loose(c: NonNullable<PackedRun["joints"][0]["clearance"]>, group: (g: PackedGroup) => Group): Clearance {
  const force = group(c.force);
  const [fx, fy] = force.columns;
  const strongest = fx.reduce((most, x, i) => Math.max(most, Math.hypot(x, fy[i])), 0);
  return { clearance: c.clearance, eccentricity: group(c.eccentricity), force, strongest };
}
