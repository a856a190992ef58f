// Zoom and shift of the mechanism with wheel, mouse and fingers.

const MARGIN = 0.12;
/** Least and greatest part of the plane that is shown, relative to the motion. */
const RANGE = [1e-4, 20];

/** The part of the plane that an image shows; y points down in it. */
export class Plane {
  private box: [x: number, y: number, width: number, height: number] = [0, 0, 1, 1];
  private fingers = new Map<number, [number, number]>();

  constructor(
    private svg: SVGSVGElement,
    private bounds: [number, number, number, number],
    private changed: () => void,
  ) {
    this.fit();
    svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.0015 * event.deltaY), event.offsetX, event.offsetY);
    }, { passive: false });
    svg.addEventListener("pointerdown", (event) => {
      svg.setPointerCapture(event.pointerId);
      this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
    svg.addEventListener("pointermove", (event) => this.moved(event));
    for (const name of ["pointerup", "pointercancel"] as const) {
      svg.addEventListener(name, (event) => this.fingers.delete(event.pointerId));
    }
    svg.addEventListener("dblclick", () => this.fit());
    new ResizeObserver(() => changed()).observe(svg);
  }

  /** Shows the whole motion. */
  fit(): void {
    const [x0, y0, x1, y1] = this.bounds;
    const margin = MARGIN * (Math.max(x1 - x0, y1 - y0) || 1);
    this.box = [x0 - margin, -y1 - margin, x1 - x0 + 2 * margin, y1 - y0 + 2 * margin];
    this.apply();
  }

  private apply(): void {
    this.svg.setAttribute("viewBox", this.box.join(" "));
    this.changed();
  }

  /** Metres a pixel. */
  scale(): number {
    return Math.max(this.box[2] / this.svg.clientWidth, this.box[3] / this.svg.clientHeight);
  }

  zoom(factor: number, px = this.svg.clientWidth / 2, py = this.svg.clientHeight / 2): void {
    const [x, y, width, height] = this.box;
    const [x0, y0, x1, y1] = this.bounds;
    const shown = (Math.max(width, height) / (Math.max(x1 - x0, y1 - y0) || 1)) * factor;
    if (shown < RANGE[0] || shown > RANGE[1]) return;
    // the image is centred in its element
    const cx = x + width / 2 + (px - this.svg.clientWidth / 2) * this.scale();
    const cy = y + height / 2 + (py - this.svg.clientHeight / 2) * this.scale();
    this.box = [cx + (x - cx) * factor, cy + (y - cy) * factor, width * factor, height * factor];
    this.apply();
  }

  private moved(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const others = [...this.fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    const now: [number, number] = [event.offsetX, event.offsetY];
    if (others.length > 0) {
      const distance = (at: [number, number]) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]) || 1;
      this.zoom(distance(before) / distance(now), (now[0] + others[0][0]) / 2, (now[1] + others[0][1]) / 2);
    } else {
      const scale = this.scale();
      this.box[0] -= (now[0] - before[0]) * scale;
      this.box[1] -= (now[1] - before[1]) * scale;
      this.apply();
    }
    this.fingers.set(event.pointerId, now);
  }
}
