// Numbers as people read them: as many decimals as the visible span calls for, the same for all values of an axis.

const MINUS = "\u2212";

const withMinus = (text: string): string => text.replace("-", MINUS);

/** Decimals needed to write every multiple of `step`. */
export function decimalsOf(step: number): number {
  for (let d = 0; d < 9; d++) {
    const scaled = step * 10 ** d;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-6 * Math.max(1, scaled)) return d;
  }
  return 9;
}

/** Labels of an axis' ticks: plain numbers, or powers of ten where those would be long. */
export function tickLabels(values: (number | null)[], step: number): string[] {
  const largest = Math.max(...values.map((v) => Math.abs(v ?? 0)));
  if (largest > 0 && (largest < 2e-4 || largest >= 1e6)) {
    const power = Math.floor(Math.log10(largest));
    const decimals = Math.min(3, decimalsOf(step / 10 ** power));
    return values.map((v) => (v === null ? "" : v === 0 ? "0" : `${withMinus((v / 10 ** power).toFixed(decimals))}e${withMinus(String(power))}`));
  }
  const decimals = decimalsOf(step);
  return values.map((v) => (v === null ? "" : withMinus(v.toFixed(decimals))));
}

/** Ticks of a log axis: all plain where that is short, else all with the power of ten. */
export function logLabels(values: (number | null)[]): string[] {
  const shown = values.filter((v): v is number => v !== null && v > 0);
  const plain = shown.every((v) => v >= 0.9e-4 && v < 1.1e5);
  return values.map((v) => {
    if (v === null || v <= 0) return "";
    return plain ? String(Number(v.toPrecision(1))) : withMinus(v.toExponential(0).replace("+", ""));
  });
}

/** A value for the readout: to about a thousandth of the visible span, or better. */
export function reading(value: number, span: number): string {
  if (!Number.isFinite(value)) return "";
  const scale = span > 0 && Number.isFinite(span) ? span : Math.abs(value);
  if (scale > 0 && (scale < 1e-4 || Math.abs(value) >= 1e7)) return withMinus(value.toExponential(3));
  const decimals = scale > 0 ? Math.min(9, Math.max(0, 4 - Math.ceil(Math.log10(scale)))) : 3;
  return withMinus(value.toFixed(decimals));
}

/** Seconds of week without needless zeros, at most a millisecond. */
export function secondsOfWeek(sow: number): string {
  const wrapped = ((sow % 604800) + 604800) % 604800;
  return String(Number(wrapped.toFixed(3)));
}

export function withUnit(label: string | undefined, unit: string | undefined): string {
  if (!unit) return label ?? "";
  return label ? `${label} [${unit}]` : `[${unit}]`;
}
