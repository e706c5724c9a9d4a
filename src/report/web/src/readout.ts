// The values under the cursor, in a line above the plot, and the dot that marks a time on a plan.
import type uPlot from "uplot";
import { lowerBound, nearest, type Content, type Curve } from "./decode";
import { el, swatch } from "./dom";
import { timedTrack } from "./extent";
import { reading, secondsOfWeek } from "./format";
import type { Range, StoredPlot } from "./model";

const REACH = 0.015; // share of the axis: a dot further from the cursor is not read

interface Scales {
  x: Range;
  y: Range;
  pixel: number; // in units of a linear x
}

export class Readout {
  private dot: HTMLElement | null = null;
  private dotTime: number | null = null;
  private readonly track: Curve | null;

  constructor(
    private readonly host: HTMLElement,
    private readonly stored: StoredPlot,
    private readonly content: Content,
    private readonly startOfWeek: number | null,
    private readonly shown: (label: string) => boolean,
  ) {
    this.track = stored.equal_aspect ? timedTrack(content.curves) : null;
  }

  /** Shows what is at x (and y, where the pointer is on this plot); returns the time there, if a plan knows it. */
  at(x: number | null, y: number | null, scales: Scales): number | null {
    this.host.replaceChildren();
    if (x === null) return null;
    if (this.stored.sky) return y === null ? null : this.onSky(x, y);
    if (this.stored.equal_aspect) return y === null ? null : this.onPlan(x, y, scales);
    if (y !== null) this.abscissa(x, scales);
    for (const curve of this.content.curves) if (this.shown(curve.label)) this.valueOf(curve, x, scales);
    for (const bars of this.content.bars) {
      const bin = lowerBound(bars.edges, x) - 1;
      if (bin < 0 || bin >= bars.heights.length || !this.shown(bars.label)) continue;
      this.item(bars.tone, "bar", bars.label, `${bars.heights[bin]}`);
    }
    for (const { tone, label, boxes } of this.content.boxes) {
      for (const [, q05, , median, , q95] of boxes) {
        if (y === null || !this.shown(label) || x < q05 || x > q95) continue;
        this.item(tone, "bar", label, `${median.toPrecision(3)} (${q05.toPrecision(3)} to ${q95.toPrecision(3)})`);
      }
    }
    return null;
  }

  private abscissa(x: number, scales: Scales): void {
    const span = scales.x.max - scales.x.min;
    const { scale, unit } = this.stored.x;
    const value = scale === "log" ? x.toPrecision(3) : reading(x, span);
    const text = scale === "time" ? `t ${value} s` : `${value}${unit ? ` ${unit}` : ""}`;
    this.host.append(el("span", { class: "at" }, text));
    if (scale === "time" && this.startOfWeek !== null) {
      this.host.append(el("span", { class: "at" }, `sow ${secondsOfWeek(this.startOfWeek + x)}`));
    }
  }

  private valueOf(curve: Curve, x: number, scales: Scales): void {
    const { series } = curve;
    if (!series.sorted) return;
    const i = nearest(series.x, x);
    if (i < 0) return;
    const xSpan = scales.x.max - scales.x.min;
    const inside = x >= series.x[0] && x <= series.x[series.x.length - 1];
    const close = Math.abs(series.x[i] - x) < REACH * xSpan;
    if (!close && (curve.kind === "points" || !inside || this.stored.x.scale === "log")) return;
    const name = this.stored.y.ticks?.find((t) => t[0] === series.y[i])?.[1];
    const log = this.stored.y.scale === "log";
    const write = (v: number) => (log ? v.toPrecision(3) : reading(v, scales.y.max - scales.y.min));
    const away = Math.abs(series.x[i] - x) > scales.pixel;
    const at = away && this.stored.x.scale === "time" ? ` at ${series.x[i].toFixed(3)} s` : "";
    const text = (name ?? write(series.y[i]) + this.width(curve, i, scales)) + at;
    this.item(curve.tone, curve.kind, curve.label, text === curve.label ? "" : text);
  }

  /** Half the width of the band at sample i itself: the drawn band of a decimated curve spans many samples. */
  private width(curve: Curve, i: number, scales: Scales): string {
    const { band, halfWidth, x } = curve.series;
    let width = halfWidth?.[i] ?? NaN;
    if (halfWidth === null && band !== null) {
      const j = nearest(band.x, x[i]);
      if (j >= 0) width = (band.upper[j] - band.lower[j]) / 2;
    }
    if (!Number.isFinite(width)) return "";
    // A sigma far below what is seen of the axis is no zero.
    const text = this.stored.y.scale === "log" ? width.toPrecision(3) : reading(width, Math.min(scales.y.max - scales.y.min, 100 * width));
    return ` \u00b1 ${text}`;
  }

  private item(toneName: string, kind: string, label: string, value: string): void {
    this.host.append(el("span", {}, swatch(toneName, kind), `${label} `, el("b", {}, value)));
  }

  private onSky(east: number, north: number): null {
    const azimuth = ((Math.atan2(east, north) * 180) / Math.PI + 360) % 360;
    const elevation = 90 - Math.hypot(east, north);
    if (elevation >= 0) this.host.append(el("span", { class: "at" }, `azimuth ${azimuth.toFixed(0)}\u00b0, elevation ${elevation.toFixed(0)}\u00b0`));
    return null;
  }

  private onPlan(x: number, y: number, scales: Scales): number | null {
    const span = scales.x.max - scales.x.min;
    const unit = this.stored.x.unit ?? "";
    this.host.append(el("span", { class: "at" }, `E ${reading(x, span)} ${unit}`), el("span", { class: "at" }, `N ${reading(y, span)} ${unit}`));
    const track = this.track?.series;
    if (!track?.t) return null;
    let best = -1;
    let least = (2 * REACH * span) ** 2;
    for (let i = 0; i < track.x.length; i++) {
      const d = (track.x[i] - x) ** 2 + (track.y[i] - y) ** 2;
      if (d < least) {
        least = d;
        best = i;
      }
    }
    if (best < 0) return null;
    const t = track.t[best];
    this.host.append(el("span", { class: "at" }, `t ${t.toFixed(2)} s`));
    if (this.startOfWeek !== null) this.host.append(el("span", { class: "at" }, `sow ${secondsOfWeek(this.startOfWeek + t)}`));
    return t;
  }

  /** Marks time t on the plan; null hides the mark, undefined keeps its time and moves it with the view. */
  placeDot(u: uPlot, t: number | null | undefined): void {
    if (t !== undefined) this.dotTime = t;
    const series = this.track?.series;
    if (!series?.t) return;
    if (this.dot === null) {
      this.dot = el("div", { class: "place" });
      u.over.append(this.dot);
    }
    const i = this.dotTime === null ? -1 : nearest(series.t, this.dotTime);
    this.dot.hidden = i < 0;
    if (i < 0) return;
    const left = u.valToPos(series.x[i], "x");
    const top = u.valToPos(series.y[i], "y");
    this.dot.hidden = left < 0 || top < 0 || left > u.over.clientWidth || top > u.over.clientHeight;
    this.dot.style.transform = `translate(${left}px, ${top}px)`;
  }
}
