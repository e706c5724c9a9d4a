// Packed arrays to typed arrays; the counterpart of src/report/pack.cpp.
import { unzlibSync } from "fflate";
import type { Packed, StoredBars, StoredBoxes, StoredLine, StoredPlot, StoredPoints, StoredSeries } from "./model";

export type Numbers = Float32Array | Float64Array;

export interface Band {
  x: Numbers;
  lower: Numbers;
  upper: Numbers;
  breaks: Set<number>;
}

export interface Series {
  x: Numbers;
  y: Numbers;
  t: Numbers | null;
  breaks: Set<number>;
  band: Band | null;
  halfWidth: Numbers | null; // of the band at each sample; the band of a decimated curve is an envelope
  sorted: boolean; // x never falls: binary search and thinning by pixel column apply
  notFinite: number;
}

export interface Curve {
  kind: "line" | "points";
  label: string;
  tone: string;
  series: Series;
  style: "line" | "dashed" | "steps";
  bandLabel: string;
  size: number; // line width or radius of a dot, px
}

export interface Bars {
  label: string;
  tone: string;
  edges: Numbers;
  heights: Numbers;
}

export interface Boxes {
  label: string;
  tone: string;
  boxes: StoredBoxes["boxes"];
}

export interface Content {
  curves: Curve[];
  bars: Bars[];
  boxes: Boxes[];
}

function words(packed: Packed): Uint32Array {
  const text = atob(packed.z);
  const zipped = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) zipped[i] = text.charCodeAt(i);
  const bytes = unzlibSync(zipped);
  const n = packed.n;
  if (bytes.length !== 4 * n) throw new Error(`an array of ${bytes.length} bytes, expected ${4 * n}`);
  const out = new Uint32Array(n);
  for (let i = 0; i < n; i++) out[i] = bytes[i] | (bytes[n + i] << 8) | (bytes[2 * n + i] << 16) | (bytes[3 * n + i] << 24);
  return out;
}

export function unpack(packed: Packed): Numbers {
  const raw = words(packed);
  if (packed.q === undefined) return new Float32Array(raw.buffer);
  const out = new Float64Array(raw.length);
  let count = 0;
  for (let i = 0; i < raw.length; i++) {
    count += raw[i];
    out[i] = packed.x0! + packed.q * count;
  }
  return out;
}

function isSorted(x: Numbers): boolean {
  for (let i = 1; i < x.length; i++) if (!(x[i] >= x[i - 1])) return false;
  return true;
}

function countNotFinite(values: Numbers): number {
  let count = 0;
  for (let i = 0; i < values.length; i++) if (!Number.isFinite(values[i])) count++;
  return count;
}

function decodeSeries(stored: StoredSeries): Series {
  const x = unpack(stored.x);
  const y = unpack(stored.y);
  const band = stored.band && {
    x: unpack(stored.band.x),
    lower: unpack(stored.band.lower),
    upper: unpack(stored.band.upper),
    breaks: new Set(stored.band.breaks ?? []),
  };
  return {
    x,
    y,
    t: stored.t ? unpack(stored.t) : null,
    breaks: new Set(stored.breaks ?? []),
    band: band ?? null,
    halfWidth: stored.half_width ? unpack(stored.half_width) : null,
    sorted: isSorted(x),
    notFinite: (stored.not_finite ?? 0) + countNotFinite(y),
  };
}

export function decodePlot(plot: StoredPlot, toneOf: (label: string, tone?: string) => string): Content {
  const line = (l: StoredLine): Curve => ({
    kind: "line",
    label: l.label,
    tone: toneOf(l.label, l.tone),
    series: decodeSeries(l.series),
    style: l.style ?? "line",
    bandLabel: l.band_label ?? "",
    size: l.width_px ?? 1.3,
  });
  const points = (p: StoredPoints): Curve => ({
    kind: "points",
    label: p.label,
    tone: toneOf(p.label, p.tone),
    series: decodeSeries(p.series),
    style: "line",
    bandLabel: "",
    size: p.radius_px ?? 1.6,
  });
  const bars = (b: StoredBars): Bars => ({
    label: b.label,
    tone: toneOf(b.label, b.tone),
    edges: unpack(b.edges),
    heights: unpack(b.heights),
  });
  return {
    curves: [...(plot.lines ?? []).map(line), ...(plot.points ?? []).map(points)],
    bars: (plot.bars ?? []).map(bars),
    boxes: (plot.boxes ?? []).map((b) => ({ label: b.label, tone: toneOf(b.label, b.tone), boxes: b.boxes })),
  };
}

/** First index with x[i] >= value. */
export function lowerBound(x: Numbers, value: number): number {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Indices [first, end) to draw for x in [min, max]: those inside and one neighbour on each side. */
export function visible(x: Numbers, sorted: boolean, min: number, max: number): [number, number] {
  if (!sorted) return [0, x.length];
  const first = Math.max(0, lowerBound(x, min) - 1);
  let end = lowerBound(x, max);
  while (end < x.length && x[end] <= max) end++;
  return [first, Math.min(x.length, end + 1)];
}

/** Index of the x nearest to value; -1 for an empty series. */
export function nearest(x: Numbers, value: number): number {
  const i = lowerBound(x, value);
  if (i === 0) return x.length > 0 ? 0 : -1;
  if (i === x.length) return i - 1;
  return value - x[i - 1] <= x[i] - value ? i - 1 : i;
}
