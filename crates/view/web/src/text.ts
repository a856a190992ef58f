// How numbers are written.

const PREFIXES = ["p", "n", "µ", "m", "", "k", "M", "G"];

/** The place of the prefix with which a value has one to three digits before its point. */
function prefix(value: number): number {
  const thousands = Math.floor(Math.log10(Math.abs(value)) / 3 + 1e-9);
  return Math.min(Math.max(thousands + 4, 0), 7);
}

/** A value with three digits and a prefix of SI. */
export function quantity(value: number, unit: string): string {
  if (value === 0 || !Number.isFinite(value)) return `${value} ${unit}`;
  const place = prefix(value);
  return `${Number((value / 1000 ** (place - 4)).toPrecision(3))} ${PREFIXES[place]}${unit}`;
}

/** Values of an axis, all with the prefix of the largest; kilograms and plain numbers have none. */
export function tickLabels(values: number[], unit: string): string[] {
  const largest = Math.max(...values.map(Math.abs));
  const place = unit === "1" || unit === "kg" || largest === 0 ? 4 : prefix(largest);
  const ending = unit === "1" ? "" : ` ${PREFIXES[place]}${unit}`;
  return values.map((value) => `${Number((value / 1000 ** (place - 4)).toPrecision(6))}${ending}`);
}
