// What a plot shows, drawn on a canvas between the axes. Coordinates are canvas pixels.
import { visible, type Band, type Bars, type Boxes, type Curve, type Series } from "./decode";
import type { Bound, Interval, Mark, Range } from "./model";
import { colour, tone } from "./tones";

export interface Frame {
  ctx: CanvasRenderingContext2D;
  left: number;
  top: number;
  width: number;
  height: number;
  dpr: number;
  x: Range;
  y: Range;
  xLog: boolean;
  yLog: boolean;
}

type Map1 = (value: number) => number;

const FAR = 1e6; // beyond it canvas coordinates lose precision
const LINES_PER_COLUMN = 2; // more samples than this per pixel column are thinned to their extremes
const BAND_ALPHA = 0.2;
export const WIDE = 4; // a line wider than this is a highlight under others
const FONT = "11px system-ui, sans-serif";

function mapping(range: Range, log: boolean, origin: number, length: number): Map1 {
  const f = log ? Math.log10 : (v: number) => v;
  const low = f(range.min);
  const scale = length / (f(range.max) - low);
  return (value) => {
    const px = origin + (f(value) - low) * scale;
    return px > FAR ? FAR : px < -FAR ? -FAR : px; // NaN (a log of nothing positive) passes and is skipped
  };
}

export const mapX = (f: Frame): Map1 => mapping(f.x, f.xLog, f.left, f.width);
export const mapY = (f: Frame): Map1 => mapping(f.y, f.yLog, f.top + f.height, -f.height);

export function clipped(f: Frame, draw: () => void): void {
  f.ctx.save();
  f.ctx.beginPath();
  f.ctx.rect(f.left, f.top, f.width, f.height);
  f.ctx.clip();
  draw();
  f.ctx.restore();
}

/** Adds the curve to the current path. Many samples in one pixel column become first, least, greatest, last: same pixels. */
function trace(f: Frame, series: Series, steps: boolean): void {
  const { ctx } = f;
  const X = mapX(f);
  const Y = mapY(f);
  const { x, y, breaks } = series;
  const [first, end] = visible(x, series.sorted, f.x.min, f.x.max);
  const thin = series.sorted && !steps && end - first > LINES_PER_COLUMN * f.width;
  let down = false;
  let column = NaN;
  let count = 0;
  let least = 0;
  let greatest = 0;
  let last = 0;
  const flush = () => {
    if (count > 1) {
      ctx.lineTo(column, least);
      ctx.lineTo(column, greatest);
      ctx.lineTo(column, last);
    }
    count = 0;
  };
  for (let i = first; i < end; i++) {
    const px = X(x[i]);
    const py = Y(y[i]);
    if (Number.isNaN(px) || Number.isNaN(py)) {
      flush();
      down = false;
      continue;
    }
    if (breaks.has(i)) {
      flush();
      down = false;
    }
    const c = Math.floor(px) + 0.5;
    if (thin && down && c === column) {
      if (py < least) least = py;
      if (py > greatest) greatest = py;
      count++;
    } else {
      flush();
      if (!down) {
        ctx.moveTo(px, py);
        ctx.lineTo(px, py); // a piece of one sample is seen as a dot
      } else {
        if (steps) ctx.lineTo(px, last);
        ctx.lineTo(px, py);
      }
      column = c;
      count = 1;
      least = greatest = py;
    }
    last = py;
    down = true;
  }
  flush();
}

/** Outline of one piece of a band: px and the two py per point, of several points in a pixel column the widest. */
function outline(f: Frame, band: Band, start: number, stop: number): [number[], number[], number[]] {
  const X = mapX(f);
  const Y = mapY(f);
  const floor = f.top + f.height + 10 * f.dpr; // a lower bound that a log axis cannot show
  const thin = stop - start > LINES_PER_COLUMN * f.width;
  const at: number[] = [];
  const upper: number[] = [];
  const lower: number[] = [];
  let column = NaN;
  for (let i = start; i < stop; i++) {
    const px = X(band.x[i]);
    const up = Y(band.upper[i]);
    const low = Y(band.lower[i]);
    const top = Number.isNaN(up) ? floor : up;
    const bottom = Number.isNaN(low) ? floor : low;
    const last = at.length - 1;
    if (thin && Math.floor(px) === column) {
      upper[last] = Math.min(upper[last], top);
      lower[last] = Math.max(lower[last], bottom);
      continue;
    }
    column = Math.floor(px);
    at.push(px);
    upper.push(top);
    lower.push(bottom);
  }
  return [at, upper, lower];
}

function drawBand(f: Frame, band: Band, sorted: boolean, toneName: string): void {
  const { ctx } = f;
  const [first, end] = visible(band.x, sorted, f.x.min, f.x.max);
  ctx.fillStyle = tone(toneName);
  ctx.globalAlpha = BAND_ALPHA;
  ctx.beginPath();
  for (let start = first; start < end; ) {
    let stop = start + 1;
    while (stop < end && !band.breaks.has(stop)) stop++;
    const [at, upper, lower] = outline(f, band, start, stop);
    ctx.moveTo(at[0], upper[0]);
    for (let i = 1; i < at.length; i++) ctx.lineTo(at[i], upper[i]);
    for (let i = at.length - 1; i >= 0; i--) ctx.lineTo(at[i], lower[i]);
    ctx.closePath();
    start = stop;
  }
  ctx.fill();
  ctx.globalAlpha = 1;
}

function drawLine(f: Frame, curve: Curve): void {
  const { ctx } = f;
  ctx.strokeStyle = tone(curve.tone);
  ctx.lineWidth = curve.size * f.dpr;
  ctx.lineJoin = "round";
  ctx.lineCap = curve.style === "dashed" ? "butt" : "round";
  ctx.setLineDash(curve.style === "dashed" ? [6 * f.dpr, 4 * f.dpr] : []);
  if (curve.size > WIDE) ctx.globalAlpha = 0.45;
  ctx.beginPath();
  trace(f, curve.series, curve.style === "steps");
  ctx.stroke();
  ctx.globalAlpha = 1;
  ctx.setLineDash([]);
}

function drawPoints(f: Frame, curve: Curve): void {
  const { ctx } = f;
  const X = mapX(f);
  const Y = mapY(f);
  const { x, y, sorted } = curve.series;
  const [first, end] = visible(x, sorted, f.x.min, f.x.max);
  const radius = Math.max(0.75, curve.size * f.dpr);
  const round = curve.size >= 2.2;
  ctx.fillStyle = tone(curve.tone);
  let lastX = NaN;
  let lastY = NaN;
  for (let i = first; i < end; i++) {
    const px = X(x[i]);
    const py = Y(y[i]);
    if (Number.isNaN(px) || Number.isNaN(py)) continue;
    if (Math.abs(px - lastX) < 0.5 && Math.abs(py - lastY) < 0.5) continue; // on top of the one before
    lastX = px;
    lastY = py;
    if (round) {
      ctx.beginPath();
      ctx.arc(px, py, radius, 0, 2 * Math.PI);
      ctx.fill();
    } else {
      ctx.fillRect(px - radius, py - radius, 2 * radius, 2 * radius);
    }
  }
}

export function drawBars(f: Frame, bars: Bars): void {
  const { ctx } = f;
  const X = mapX(f);
  const Y = mapY(f);
  const base = f.top + f.height;
  ctx.fillStyle = tone(bars.tone);
  ctx.globalAlpha = 0.75;
  for (let i = 0; i < bars.heights.length; i++) {
    const left = X(bars.edges[i]);
    const top = Y(bars.heights[i]);
    if (Number.isNaN(top)) continue; // nothing in it, on a log axis
    ctx.fillRect(left, top, Math.max(1, X(bars.edges[i + 1]) - left - f.dpr), base - top);
  }
  ctx.globalAlpha = 1;
}

/** Whiskers from 5 to 95 %, a box from 25 to 75 %, a stroke at the median. */
export function drawBoxes(f: Frame, boxes: Boxes): void {
  const { ctx } = f;
  const X = mapX(f);
  const Y = mapY(f);
  const half = Math.min(9 * f.dpr, (0.3 * f.height) / Math.max(1, f.y.max - f.y.min));
  ctx.strokeStyle = ctx.fillStyle = tone(boxes.tone);
  ctx.lineWidth = 1.3 * f.dpr;
  for (const [y, q05, q25, q50, q75, q95] of boxes.boxes) {
    const [low, left, middle, right, high] = [q05, q25, q50, q75, q95].map(X);
    const py = Y(y);
    ctx.globalAlpha = BAND_ALPHA;
    ctx.fillRect(left, py - half, right - left, 2 * half);
    ctx.globalAlpha = 1;
    ctx.strokeRect(left, py - half, right - left, 2 * half);
    ctx.beginPath();
    for (const [end, side] of [[low, left], [high, right]]) {
      ctx.moveTo(end, py - half / 2);
      ctx.lineTo(end, py + half / 2);
      ctx.moveTo(end, py);
      ctx.lineTo(side, py);
    }
    ctx.stroke();
    ctx.lineWidth = 2.6 * f.dpr;
    ctx.beginPath();
    ctx.moveTo(middle, py - half);
    ctx.lineTo(middle, py + half);
    ctx.stroke();
    ctx.lineWidth = 1.3 * f.dpr;
  }
}

export function drawIntervals(f: Frame, intervals: Interval[]): void {
  const { ctx } = f;
  const X = mapX(f);
  for (const interval of intervals) {
    const left = X(interval.from);
    const width = Math.max(f.dpr, X(interval.to) - left);
    ctx.fillStyle = tone(interval.tone ?? "muted");
    ctx.globalAlpha = 0.14;
    ctx.fillRect(left, f.top, width, f.height);
    ctx.globalAlpha = 1;
  }
}

function scaledFont(f: Frame): string {
  return FONT.replace("11px", `${11 * f.dpr}px`);
}

/** Names of shaded stretches, where there is room for them. */
export function drawIntervalLabels(f: Frame, intervals: Interval[]): void {
  const { ctx } = f;
  const X = mapX(f);
  ctx.font = scaledFont(f);
  ctx.textBaseline = "top";
  ctx.textAlign = "left";
  ctx.fillStyle = colour("--ink-soft");
  for (const interval of intervals) {
    if (!interval.label) continue;
    const left = Math.max(f.left, X(interval.from));
    const room = Math.min(f.left + f.width, X(interval.to)) - left;
    if (ctx.measureText(interval.label).width + 6 * f.dpr <= room) ctx.fillText(interval.label, left + 3 * f.dpr, f.top + 3 * f.dpr);
  }
}

export function drawBounds(f: Frame, bounds: Bound[]): void {
  const { ctx } = f;
  const Y = mapY(f);
  ctx.font = scaledFont(f);
  ctx.textAlign = "right";
  ctx.textBaseline = "bottom";
  for (const bound of bounds) {
    ctx.lineWidth = f.dpr;
    const py = Math.round(Y(bound.value)) + 0.5;
    if (Number.isNaN(py)) continue;
    ctx.strokeStyle = tone(bound.tone ?? "muted");
    ctx.setLineDash([4 * f.dpr, 3 * f.dpr]);
    ctx.beginPath();
    ctx.moveTo(f.left, py);
    ctx.lineTo(f.left + f.width, py);
    ctx.stroke();
    ctx.setLineDash([]);
    if (bound.label) label(f, bound.label, f.left + f.width - 4 * f.dpr, py - f.dpr);
  }
}

/** Where labels of the sky stand: just outside the horizon, which is at 90. */
export const SKY_RANGE: Readonly<Range> = { min: -104, max: 104 };

/** Rings of elevation 0, 30 and 60 deg about the zenith, spokes each 30 deg of azimuth, and the directions by name. */
export function drawSky(f: Frame): void {
  const { ctx } = f;
  const X = mapX(f);
  const Y = mapY(f);
  const HORIZON = 90;
  ctx.lineWidth = f.dpr;
  ctx.strokeStyle = colour("--rule");
  ctx.beginPath();
  for (let azimuth = 0; azimuth < 180; azimuth += 30) {
    const east = HORIZON * Math.sin((azimuth * Math.PI) / 180);
    const north = HORIZON * Math.cos((azimuth * Math.PI) / 180);
    ctx.moveTo(X(-east), Y(-north));
    ctx.lineTo(X(east), Y(north));
  }
  for (const zenith of [30, 60, HORIZON]) {
    const radius = X(zenith) - X(0);
    ctx.moveTo(X(zenith), Y(0));
    ctx.arc(X(0), Y(0), radius, 0, 2 * Math.PI);
  }
  ctx.stroke();
  nameSky(f, X, Y, HORIZON);
}

function nameSky(f: Frame, X: Map1, Y: Map1, horizon: number): void {
  const { ctx } = f;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.font = `600 ${scaledFont(f)}`;
  const outside = horizon + 7;
  for (const [name, east, north] of [["N", 0, 1], ["E", 1, 0], ["S", 0, -1], ["W", -1, 0]] as const) {
    label(f, name, X(outside * east), Y(outside * north));
  }
  ctx.font = scaledFont(f);
  for (const elevation of [0, 30, 60]) {
    const along = (horizon - elevation) * Math.SQRT1_2; // on the ring, to the north-east
    label(f, `${elevation}\u00b0`, X(along), Y(along));
  }
}

/** Text with a halo of the ground's colour, legible over curves. */
function label(f: Frame, text: string, px: number, py: number): void {
  f.ctx.strokeStyle = colour("--ground");
  f.ctx.lineWidth = 3 * f.dpr;
  f.ctx.lineJoin = "round";
  f.ctx.strokeText(text, px, py);
  f.ctx.fillStyle = colour("--ink");
  f.ctx.fillText(text, px, py);
}

export function drawMarks(f: Frame, marks: Mark[]): void {
  const X = mapX(f);
  const Y = mapY(f);
  f.ctx.font = `600 ${scaledFont(f)}`;
  f.ctx.textBaseline = "bottom";
  for (const mark of marks) {
    const px = X(mark.x);
    const fits = px + 5 * f.dpr + f.ctx.measureText(mark.label).width <= f.left + f.width; // else to the left of its point
    f.ctx.textAlign = fits ? "left" : "right";
    label(f, mark.label, px + (fits ? 5 : -5) * f.dpr, Y(mark.y) - 3 * f.dpr);
  }
}

/** A bar of a round length, about a sixth of the width, at the lower left of a plan. */
export function drawScaleBar(f: Frame): void {
  const { ctx } = f;
  const perPixel = (f.x.max - f.x.min) / f.width;
  const wanted = (f.width / 6) * perPixel;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const metres = [5, 2, 1].map((k) => k * power).find((v) => v <= wanted) ?? power;
  const length = metres / perPixel;
  const left = f.left + 14 * f.dpr;
  const bottom = f.top + f.height - 14 * f.dpr;
  ctx.strokeStyle = colour("--ink");
  ctx.lineWidth = 1.5 * f.dpr;
  ctx.beginPath();
  ctx.moveTo(left, bottom - 5 * f.dpr);
  ctx.lineTo(left, bottom);
  ctx.lineTo(left + length, bottom);
  ctx.lineTo(left + length, bottom - 5 * f.dpr);
  ctx.stroke();
  ctx.font = scaledFont(f);
  ctx.textAlign = "center";
  ctx.textBaseline = "bottom";
  const text = metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` : `${Number((metres * 1000).toPrecision(3))} mm`;
  label(f, text, left + length / 2, bottom - 3 * f.dpr);
}

/** An arrow to the top, at the upper right of a plan. */
export function drawNorthArrow(f: Frame, name: string): void {
  const { ctx } = f;
  const x = f.left + f.width - 26 * f.dpr;
  const top = f.top + 14 * f.dpr;
  const length = 30 * f.dpr;
  const half = 6 * f.dpr;
  ctx.fillStyle = colour("--ink");
  ctx.beginPath();
  ctx.moveTo(x, top);
  ctx.lineTo(x - half, top + length);
  ctx.lineTo(x, top + length - half);
  ctx.lineTo(x + half, top + length);
  ctx.closePath();
  ctx.fill();
  ctx.font = `600 ${scaledFont(f)}`;
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  label(f, name, x, top + length + 3 * f.dpr);
}

/** All bands, then highlights, dots, and lines: nothing wide lies over something narrow, and dense dots hide no line. */
export function drawCurves(f: Frame, curves: Curve[]): void {
  for (const c of curves) if (c.series.band) drawBand(f, c.series.band, c.series.sorted, c.tone);
  for (const c of curves) if (c.kind === "line" && c.size > WIDE) drawLine(f, c);
  for (const c of curves) if (c.kind === "points") drawPoints(f, c);
  for (const c of curves) if (c.kind === "line" && c.size <= WIDE) drawLine(f, c);
}
