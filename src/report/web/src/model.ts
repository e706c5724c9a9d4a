// The stored page, schema "coast.page/1", as coast/report/page.hpp describes it; members at their default are absent.

export interface Packed {
  n: number;
  z: string;
  x0?: number;
  q?: number;
}

export interface StoredSeries {
  x: Packed;
  y: Packed;
  t?: Packed;
  half_width?: Packed;
  breaks?: number[];
  not_finite?: number;
  band?: { x: Packed; lower: Packed; upper: Packed; breaks?: number[] };
}

export type Scale = "linear" | "log" | "time";
export type Verdict = "none" | "good" | "warn" | "bad";

export interface Axis {
  label?: string;
  unit?: string;
  scale?: Scale;
  ticks?: [number, string][];
  range?: [number, number];
}

export interface StoredLine {
  label: string;
  series: StoredSeries;
  tone?: string;
  style?: "line" | "dashed" | "steps";
  band_label?: string;
  width_px?: number;
  hidden?: boolean;
}

export interface StoredPoints {
  label: string;
  series: StoredSeries;
  tone?: string;
  radius_px?: number;
}

export interface StoredBars {
  label: string;
  edges: Packed;
  heights: Packed;
  tone?: string;
}

export interface StoredBoxes {
  label: string;
  boxes: [number, number, number, number, number, number][]; // y, then the quantiles 5, 25, 50, 75, 95 %
  tone?: string;
}

export interface Interval {
  from: number;
  to: number;
  label?: string;
  tone?: string;
}

export interface Bound {
  value: number;
  label?: string;
  tone?: string;
}

export interface Mark {
  x: number;
  y: number;
  label: string;
}

export interface StoredPlot {
  title?: string;
  x: Axis;
  y: Axis;
  lines?: StoredLine[];
  points?: StoredPoints[];
  bars?: StoredBars[];
  boxes?: StoredBoxes[];
  intervals?: Interval[];
  bounds?: Bound[];
  marks?: Mark[];
  equal_aspect?: boolean;
  sky?: boolean;
  link?: string;
  height_px?: number;
}

export interface StoredPanel {
  id: string;
  title: string;
  caption?: string;
  columns?: number;
  plots?: StoredPlot[];
}

export type StoredCell = string | { text: string; verdict: Verdict };

export interface StoredTable {
  id: string;
  title: string;
  caption?: string;
  columns?: { label: string; unit?: string; numeric?: boolean }[];
  rows?: StoredCell[][];
}

export interface Note {
  kind?: "info" | "warning" | "code";
  title?: string;
  text: string;
}

export interface StoredSection {
  id: string;
  title: string;
  lead?: string;
  notes?: Note[];
  tables?: StoredTable[];
  panels?: StoredPanel[];
}

export interface Tile {
  label: string;
  value: string;
  unit?: string;
  verdict?: Verdict;
  explanation?: string;
  shares?: { label: string; fraction: number; tone: string }[];
  section?: string;
}

export interface StoredPage {
  schema: string;
  title: string;
  subtitle?: string;
  footer?: string;
  start?: { gps_ns: number; week: number; sow: number; text: string };
  tiles?: Tile[];
  sections?: StoredSection[];
}

export interface Range {
  min: number;
  max: number;
}
