// How numbers are written.

const PREFIXES = ["p", "n", "µ", "m", "", "k", "M", "G"];

/** A value with three digits and a prefix of SI. */
export function quantity(value: number, unit: string): string {
  if (value === 0 || !Number.isFinite(value)) return `${value} ${unit}`;
  const thousands = Math.floor(Math.log10(Math.abs(value)) / 3 + 1e-9);
  const place = Math.min(Math.max(thousands + 4, 0), 7);
  return `${Number((value / 1000 ** (place - 4)).toPrecision(3))} ${PREFIXES[place]}${unit}`;
}
