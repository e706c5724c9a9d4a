// Ranges of axes: of the data, of what is visible in a window, and with the same length of a metre in both directions.
import { visible, type Content, type Curve, type Numbers } from "./decode";
import type { Bound, Range } from "./model";

export const EMPTY: Readonly<Range> = { min: Infinity, max: -Infinity };

export const isEmpty = (r: Range): boolean => !(r.min <= r.max);

export function join(a: Range, b: Range): Range {
  return { min: Math.min(a.min, b.min), max: Math.max(a.max, b.max) };
}

function extend(range: Range, values: Numbers, positive: boolean, first = 0, end = values.length): Range {
  let { min, max } = range;
  for (let i = first; i < end; i++) {
    const v = values[i];
    if (!Number.isFinite(v) || (positive && v <= 0)) continue;
    if (v < min) min = v;
    if (v > max) max = v;
  }
  return { min, max };
}

export function xExtent(content: Content, log: boolean): Range {
  let range: Range = { ...EMPTY };
  for (const c of content.curves) range = extend(range, c.series.x, log);
  for (const b of content.bars) range = extend(range, b.edges, log);
  for (const b of content.boxes) for (const [, ...quantiles] of b.boxes) range = extend(range, Float64Array.from(quantiles), log);
  return range;
}

/** Extent in y of what lies within `x`, bands included. */
export function yExtent(content: Content, shown: (label: string) => boolean, x: Range, log: boolean): Range {
  let range: Range = { ...EMPTY };
  const take = (xs: Numbers, sorted: boolean, values: Numbers[]) => {
    let [first, end] = visible(xs, sorted, x.min, x.max);
    if (first < end && xs[first] < x.min && sorted && end - first > 2) first++; // the neighbours outside only guide the line
    if (end > first && xs[end - 1] > x.max && sorted && end - first > 2) end--;
    for (const v of values) range = extend(range, v, log, first, end);
  };
  for (const c of content.curves) {
    if (!shown(c.label)) continue;
    take(c.series.x, c.series.sorted, [c.series.y]);
    if (c.series.band) take(c.series.band.x, c.series.sorted, [c.series.band.lower, c.series.band.upper]);
  }
  for (const b of content.bars) {
    if (!shown(b.label)) continue;
    range = extend(range, b.heights, log);
    if (!log) range = join(range, { min: 0, max: 0 });
  }
  for (const b of content.boxes) if (shown(b.label)) range = extend(range, Float64Array.from(b.boxes, (box) => box[0]), log);
  return range;
}

/** Bounds are shown unless the data would then fill less than a third of the axis. */
export function withBounds(range: Range, bounds: Bound[]): Range {
  if (isEmpty(range)) return bounds.reduce((r, b) => join(r, { min: b.value, max: b.value }), range);
  return bounds.reduce((r, b) => {
    const wider = join(r, { min: b.value, max: b.value });
    return wider.max - wider.min <= 3 * (range.max - range.min) ? wider : r;
  }, range);
}

/** A range that can be an axis: not empty, not a point, with some air. */
export function padded(range: Range, log: boolean, share: number): Range {
  if (isEmpty(range)) return log ? { min: 0.1, max: 10 } : { min: -1, max: 1 };
  if (log) {
    const low = Math.log10(range.min);
    const high = Math.log10(range.max);
    const air = Math.max(0.15, (high - low) * share);
    return { min: 10 ** (low - air), max: 10 ** (high + air) };
  }
  const span = range.max - range.min;
  const least = Math.max(1e-12, 1e-6 * Math.max(Math.abs(range.min), Math.abs(range.max))); // of 32 bit floats
  if (span < least) {
    const air = range.max === 0 ? 1 : Math.max(least, Math.abs(range.max) * 1e-3);
    return { min: range.min - air, max: range.max + air };
  }
  return { min: range.min - span * share, max: range.max + span * share };
}

/** Widens the narrower direction so that a unit is as long in x as in y on a plot of the given size. */
export function equalAspect(x: Range, y: Range, width: number, height: number): [Range, Range] {
  const perPixel = Math.max((x.max - x.min) / width, (y.max - y.min) / height);
  const around = (r: Range, length: number): Range => {
    const middle = (r.min + r.max) / 2;
    return { min: middle - (perPixel * length) / 2, max: middle + (perPixel * length) / 2 };
  };
  return [around(x, width), around(y, height)];
}

/** Zooms by `factor` about the value `anchor`; on a log axis in its logarithm. */
export function zoomed(range: Range, anchor: number, factor: number, log: boolean): Range {
  if (log) {
    return { min: anchor * (range.min / anchor) ** factor, max: anchor * (range.max / anchor) ** factor };
  }
  return { min: anchor + (range.min - anchor) * factor, max: anchor + (range.max - anchor) * factor };
}

/** Moves by a share of the axis' length. */
export function shifted(range: Range, share: number, log: boolean): Range {
  if (log) {
    const ratio = (range.max / range.min) ** share;
    return { min: range.min * ratio, max: range.max * ratio };
  }
  const step = (range.max - range.min) * share;
  return { min: range.min + step, max: range.max + step };
}

/** The curve of a plan that carries times, the longest one. */
export function timedTrack(curves: Curve[]): Curve | null {
  const timed = curves.filter((c) => c.series.t !== null);
  return timed.reduce<Curve | null>((best, c) => (best === null || c.series.x.length > best.series.x.length ? c : best), null);
}
