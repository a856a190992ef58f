// Elements of SVG.

const SPACE = "http://www.w3.org/2000/svg";

export type Attributes = Record<string, string | number>;

/** A new element below another. */
export function add<K extends keyof SVGElementTagNameMap>(parent: Element, tag: K, attributes: Attributes = {}): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SPACE, tag);
  set(element, attributes);
  parent.append(element);
  return element;
}

/** Sets attributes. */
export function set(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
}
