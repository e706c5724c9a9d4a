// Axes for uPlot: ticks, labels and widths.
import type uPlot from "uplot";
import { logLabels, secondsOfWeek, tickLabels, withUnit } from "./format";
import type { Axis } from "./model";
import { colour } from "./tones";

const TIME_LABELS = ["time since start, and GPS seconds of week below [s]", "time since start, GPS sow below [s]", "time, GPS sow [s]"];
const FONT = "12px system-ui, sans-serif";
const LABEL_FONT = "600 12px system-ui, sans-serif";
const ROW_FONT = "11px system-ui, sans-serif";
const ROW_LETTER = 6.2; // px
const Y_VALUES_WIDTH = 54; // the same for all plots, so that their time axes stand below each other
const X_SPACE = 84;
const X_SPACE_PLAIN = 56; // without seconds of week
const Y_SPACE = 28;
const TIME_STEPS = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 10800, 21600, 43200, 86400];
const SECOND_FRACTIONS = [1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5];

export interface XStyle {
  labels: boolean; // a plot in the middle of a stack leaves them to the last one
  startOfWeek: number | null; // seconds of week of t = 0
}

function base(axis: Axis): uPlot.Axis {
  return {
    font: FONT,
    labelFont: LABEL_FONT,
    stroke: () => colour("--ink-soft"),
    grid: { stroke: () => colour("--grid"), width: 1 },
    ticks: { stroke: () => colour("--rule"), width: 1, size: 4 },
    border: { show: true, stroke: () => colour("--rule"), width: 1 },
    gap: 4,
    label: withUnit(axis.label, axis.unit),
    labelGap: 2,
    labelSize: 18,
    ...(axis.scale === "log" ? { splits: logSplits, filter: (_u: uPlot, splits: number[]) => splits } : {}),
  };
}

/** The fullest name of the time axis that is not longer than the axis. */
function longestThatFits(u: uPlot): string {
  u.ctx.save();
  u.ctx.font = LABEL_FONT;
  const text = TIME_LABELS.find((t) => u.ctx.measureText(t).width <= u.bbox.width / devicePixelRatio) ?? TIME_LABELS[TIME_LABELS.length - 1];
  u.ctx.restore();
  return text;
}

function values(axis: Axis): uPlot.Axis.DynamicValues {
  if (axis.scale === "log") return (_u, splits) => logLabels(splits);
  return (_u, splits, _i, _space, step) => tickLabels(splits, step);
}

/** Decades, and 2 and 5 of each where fewer than two decades are seen. */
function logSplits(_u: uPlot, _i: number, min: number, max: number): number[] {
  const low = Math.floor(Math.log10(min));
  const high = Math.ceil(Math.log10(max));
  const factors = Math.log10(max / min) < 2 ? [1, 2, 5] : [1];
  const out: number[] = [];
  for (let p = low; p <= high; p++) for (const k of factors) out.push(Number(`${k}e${p}`));
  return out.filter((v) => v >= min && v <= max);
}

function named(axis: Axis): Partial<uPlot.Axis> {
  const ticks = axis.ticks ?? [];
  return { splits: ticks.map((t) => t[0]), values: ticks.map((t) => t[1]) };
}

/** Names of rows take at most half of a narrow plot: in two lines then, so small that rows of 25 px hold them. */
function rowNames(axis: Axis): Partial<uPlot.Axis> {
  const names = (axis.ticks ?? []).map((t) => t[1]);
  const letters = Math.max(...names.map((name) => name.length));
  const width = 14 + ROW_LETTER * letters;
  const narrow = (u: uPlot) => width > 0.5 * u.width;
  return {
    ...named(axis),
    font: ROW_FONT,
    lineGap: 1.1,
    values: (u) => (narrow(u) ? names.map((name) => inTwoLines(name, letters / 2)) : names),
    size: (u) => Math.max(Y_VALUES_WIDTH + 18, narrow(u) ? 20 + ROW_LETTER * (letters / 2 + 4) : width),
  };
}

/** Broken at the first space behind which no more than about half is left. */
function inTwoLines(name: string, half: number): string {
  if (name.length <= half + 4) return name;
  const at = name.indexOf(" ", Math.floor(name.length - half - 4));
  return at < 0 ? name : `${name.slice(0, at)}\n${name.slice(at + 1)}`;
}

export function yAxis(axis: Axis): uPlot.Axis {
  const out: uPlot.Axis = { ...base(axis), scale: "y", side: 3, space: Y_SPACE, values: values(axis), size: Y_VALUES_WIDTH };
  if (!axis.ticks?.length) return out;
  return { ...out, ...rowNames(axis), label: out.label || undefined };
}

export function xAxis(axis: Axis, style: XStyle): uPlot.Axis {
  const space = axis.scale === "time" ? X_SPACE : X_SPACE_PLAIN;
  const out: uPlot.Axis = { ...base(axis), scale: "x", side: 2, space, values: values(axis), size: 26 };
  if (axis.ticks?.length) Object.assign(out, named(axis));
  if (axis.scale === "time") out.incrs = [...SECOND_FRACTIONS, ...TIME_STEPS];
  if (!style.labels) {
    return { ...out, values: (_u: uPlot, splits: number[]) => splits.map(() => ""), label: undefined, size: 6 };
  }
  if (axis.scale !== "time") return out;
  const start = style.startOfWeek;
  if (start === null) return out;
  out.label = longestThatFits;
  out.size = 40;
  out.values = (_u: uPlot, splits: (number | null)[], _i: number, _space: number, step: number) =>
    tickLabels(splits, step).map((text, i) => (text === "" ? "" : `${text}\n${secondsOfWeek(start + splits[i]!)}`));
  return out;
}
