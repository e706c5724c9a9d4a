// One plot: uPlot supplies axes, scales, selection and cursor; draw.ts draws the data, each curve on its own abscissae.
import uPlot from "uplot";
import { xAxis, yAxis } from "./axes";
import type { Content } from "./decode";
import { clipped, drawBars, drawBounds, drawBoxes, drawCurves, drawIntervalLabels, drawIntervals, drawMarks, drawNorthArrow, drawScaleBar, drawSky, SKY_RANGE, type Frame } from "./draw";
import { equalAspect, padded, shifted, withBounds, xExtent, yExtent, zoomed } from "./extent";
import { TIME, type Hub, type Member } from "./hub";
import type { Range, StoredPlot } from "./model";
import { Readout } from "./readout";

const Y_AIR = 0.06;
const X_AIR = 0.02;
const RIGHT_MARGIN = 14; // px: half a label of a tick at the very end
const RIGHT_MARGIN_TIME = 36; // with seconds of week
const WHEEL_RATE = 0.0015; // per pixel of wheel travel
const WHEEL_LINE = 16; // px, where the browser counts lines
const LEAST_SHARE = 1e-7; // of the home range: deepest zoom

export interface PlotOptions {
  height: number;
  xLabels: boolean;
  startOfWeek: number | null;
  shown: (label: string) => boolean;
}

export class PlotView implements Member {
  readonly group: string;
  readonly isPlan: boolean;
  private u: uPlot | null = null;
  private x: Range = { min: 0, max: 1 };
  private y: Range = { min: 0, max: 1 };
  private yHeld = false; // the user chose the range in y
  private asked: { x: Range; y: Range } | null = null; // of a plan, before it was widened to equal scales
  private onScreen = false;
  private stale = false;
  private queued = false;
  private readonly xLog: boolean;
  private readonly yLog: boolean;
  private readonly extent: Range;
  private readonly readout: Readout;

  constructor(
    private readonly host: HTMLElement,
    readoutHost: HTMLElement,
    private readonly stored: StoredPlot,
    private readonly content: Content,
    private readonly hub: Hub,
    private readonly options: PlotOptions,
  ) {
    this.group = stored.link || (stored.x.scale === "time" ? TIME : "");
    this.isPlan = stored.equal_aspect === true || stored.sky === true;
    this.xLog = stored.x.scale === "log";
    this.yLog = stored.y.scale === "log";
    this.extent = xExtent(content, this.xLog);
    this.readout = new Readout(readoutHost, stored, content, options.startOfWeek, options.shown);
    hub.add(this);
    host.style.height = `${options.height}px`;
    host.dataset.group = this.isPlan ? "plan" : this.group;
  }

  dataRange(): Range {
    return this.extent;
  }

  /** Called once when the plot comes near the screen, and at every change of that. */
  setOnScreen(on: boolean): void {
    this.onScreen = on;
    if (on) this.ensure();
    if (on && this.stale) this.apply();
  }

  ensure(): void {
    if (this.u !== null) return;
    this.create();
  }

  resize(): void {
    const width = this.host.clientWidth;
    if (this.u === null || width === 0 || width === this.u.width) return;
    this.u.setSize({ width, height: this.options.height });
    if (this.asked) this.setBoth(this.asked.x, this.asked.y);
    this.apply();
  }

  /** New colours or a curve switched on or off. */
  refresh(): void {
    this.autoY();
    this.schedule();
  }

  redrawNow(): void {
    this.ensure();
    this.u?.redraw(false, true);
  }

  setX(range: Range): void {
    const home = this.homeX();
    const share = this.xLog ? Math.log(range.max / range.min) / Math.log(home.max / home.min) : (range.max - range.min) / (home.max - home.min);
    if (!(share > LEAST_SHARE)) return;
    this.x = { ...range };
    this.autoY();
    this.schedule();
  }

  resetView(): void {
    this.yHeld = false;
    this.x = this.homeX();
    this.autoY();
    if (this.u !== null && this.isPlan) this.setBoth(this.x, this.y);
    this.schedule();
  }

  showCursor(x: number | null): void {
    if (this.u === null || !this.onScreen) return;
    const left = x === null ? -10 : this.u.valToPos(x, "x");
    this.u.setCursor({ left, top: -10 }, false);
    this.readout.at(x, null, this.scales());
  }

  showTime(t: number | null): void {
    if (this.u === null || !this.onScreen) return;
    this.readout.placeDot(this.u, t);
  }

  private homeX(): Range {
    if (this.stored.sky) return { ...SKY_RANGE };
    if (this.stored.x.range) return { min: this.stored.x.range[0], max: this.stored.x.range[1] };
    if (this.group) return { ...this.hub.home(this.group) };
    return padded(this.extent, this.xLog, this.content.bars.length ? 0 : X_AIR);
  }

  private autoY(): void {
    if (this.yHeld) return;
    const { y } = this.stored;
    const ticks = y.ticks?.map((t) => t[0]) ?? [];
    if (this.stored.sky) {
      this.y = { ...SKY_RANGE };
    } else if (ticks.length) {
      this.y = { min: Math.min(...ticks) - 0.7, max: Math.max(...ticks) + 0.7 };
    } else if (y.range && this.atHome()) {
      this.y = { min: y.range[0], max: y.range[1] };
    } else {
      const data = yExtent(this.content, this.options.shown, this.x, this.yLog);
      this.y = padded(withBounds(data, this.stored.bounds ?? []), this.yLog, Y_AIR);
      if (this.content.bars.length && !this.yLog) this.y.min = 0;
    }
  }

  private atHome(): boolean {
    const home = this.homeX();
    return this.x.min === home.min && this.x.max === home.max;
  }

  private scales(): { x: Range; y: Range; pixel: number } {
    const width = this.u?.over.clientWidth ?? 0;
    return { x: this.x, y: this.y, pixel: width > 0 ? (this.x.max - this.x.min) / width : Infinity };
  }

  private schedule(): void {
    this.stale = true;
    if (this.u === null || !this.onScreen || this.queued) return;
    this.queued = true;
    requestAnimationFrame(() => {
      this.queued = false;
      this.apply();
    });
  }

  private apply(): void {
    const u = this.u;
    if (u === null) return;
    this.stale = false;
    u.batch(() => {
      u.setScale("x", { ...this.x });
      u.setScale("y", { ...this.y });
    });
    this.readout.placeDot(u, undefined);
  }

  private create(): void {
    this.x = this.stale ? this.x : this.homeX();
    this.autoY();
    this.u = new uPlot(this.uplotOptions(), [[this.x.min, this.x.max], [null, null]], this.host);
    this.u.over.addEventListener("wheel", (e) => this.onWheel(e), { passive: false });
    this.u.over.addEventListener("mouseleave", () => this.leave());
    if (this.isPlan) {
      this.setBoth(this.x, this.y);
      this.apply();
    }
  }

  private uplotOptions(): uPlot.Options {
    const { stored, options } = this;
    const both = this.isPlan || this.group !== TIME;
    return {
      width: Math.max(200, this.host.clientWidth),
      height: options.height,
      legend: { show: false },
      padding: [6, stored.sky ? 0 : stored.x.scale === "time" && options.startOfWeek !== null ? RIGHT_MARGIN_TIME : RIGHT_MARGIN, 0, 0],
      scales: {
        x: { time: false, distr: this.xLog ? 3 : 1, range: () => [this.x.min, this.x.max] },
        y: { distr: this.yLog ? 3 : 1, range: () => [this.y.min, this.y.max] },
      },
      axes: stored.sky ? [{ show: false }, { show: false }] : [xAxis(stored.x, { labels: options.xLabels, startOfWeek: options.startOfWeek }), yAxis(stored.y)],
      series: [{}, { scale: "y" }],
      cursor: {
        x: true,
        y: both,
        points: { show: false },
        drag: { x: true, y: true, uni: 30, dist: 4, setScale: false },
        bind: {
          mousedown: (_u, _target, handler) => (e: MouseEvent) => this.onMouseDown(e, handler),
          dblclick: () => () => (this.hub.reset(this), null),
        },
      },
      hooks: {
        drawClear: [(u) => this.drawBehind(u)],
        draw: [(u) => this.drawData(u)],
        setSelect: [(u) => this.onSelect(u)],
        setCursor: [(u) => this.onCursor(u)],
      },
    };
  }

  // --- drawing

  private frame(u: uPlot): Frame {
    const { left, top, width, height } = u.bbox;
    const range = (key: string): Range => ({ min: u.scales[key].min!, max: u.scales[key].max! });
    return { ctx: u.ctx, left, top, width, height, dpr: devicePixelRatio, x: range("x"), y: range("y"), xLog: this.xLog, yLog: this.yLog };
  }

  private drawBehind(u: uPlot): void {
    const f = this.frame(u);
    clipped(f, () => (this.stored.sky ? drawSky(f) : drawIntervals(f, this.stored.intervals ?? [])));
  }

  private drawData(u: uPlot): void {
    const began = performance.now();
    const f = this.frame(u);
    const { stored, content } = this;
    clipped(f, () => {
      for (const b of content.bars) if (this.options.shown(b.label)) drawBars(f, b);
      for (const b of content.boxes) if (this.options.shown(b.label)) drawBoxes(f, b);
      drawCurves(f, content.curves.filter((c) => this.options.shown(c.label)));
      drawBounds(f, stored.bounds ?? []);
      drawIntervalLabels(f, stored.intervals ?? []);
      drawMarks(f, stored.marks ?? []);
      if (this.isPlan && this.stored.x.unit === "m") drawScaleBar(f);
      if (stored.equal_aspect) drawNorthArrow(f, stored.y.label === "north" ? "N" : "grid N");
    });
    Object.assign(this.host.dataset, { xMin: f.x.min, xMax: f.x.max, yMin: f.y.min, yMax: f.y.max, drawMs: performance.now() - began });
  }

  // --- the pointer

  private onCursor(u: uPlot): void {
    const { left, top } = u.cursor;
    if (left === undefined || left < 0 || top === undefined || top < 0) return; // placed by showCursor, or away
    const x = u.posToVal(left, "x");
    const t = this.readout.at(x, u.posToVal(top, "y"), this.scales());
    if (this.isPlan) {
      this.hub.time(t, this);
      this.readout.placeDot(u, t);
    } else {
      this.hub.cursor(this, x);
    }
  }

  private leave(): void {
    this.readout.at(null, null, this.scales());
    if (this.isPlan) this.hub.time(null, this);
    else this.hub.cursor(this, null);
    if (this.u) this.readout.placeDot(this.u, null);
    this.host.removeAttribute("data-active");
    this.host.removeAttribute("data-hint");
  }

  private onSelect(u: uPlot): void {
    const { left, top, width, height } = u.select;
    if (width < 4 && height < 4) return;
    const x = { min: u.posToVal(left, "x"), max: u.posToVal(left + width, "x") };
    const y = { min: u.posToVal(top + height, "y"), max: u.posToVal(top, "y") };
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (this.isPlan) {
      this.setBoth(x, y);
      return;
    }
    if (height > 4 && height < u.over.clientHeight - 1) this.holdY(y);
    if (width > 4 && width < u.over.clientWidth - 1) this.hub.zoom(this, x);
  }

  private holdY(y: Range): void {
    this.y = y;
    this.yHeld = true;
    this.schedule();
  }

  private setBoth(x: Range, y: Range): void {
    const { width, height } = this.u!.bbox;
    this.asked = { x, y };
    [this.x, this.y] = equalAspect(x, y, width, height);
    this.yHeld = true;
    this.schedule();
  }

  private onMouseDown(e: MouseEvent, zoom: (e: MouseEvent) => null): null {
    this.host.dataset.active = "true";
    this.host.removeAttribute("data-hint");
    if (e.button !== 0 || !(e.shiftKey || this.hub.mode === "pan")) return zoom(e);
    this.startPan(e);
    return null;
  }

  private startPan(start: MouseEvent): void {
    const from = { x: { ...this.x }, y: { ...this.y } };
    const { clientWidth, clientHeight } = this.u!.over;
    const move = (e: MouseEvent) => {
      const x = shifted(from.x, (start.clientX - e.clientX) / clientWidth, this.xLog);
      const y = shifted(from.y, (e.clientY - start.clientY) / clientHeight, this.yLog);
      if (this.isPlan) {
        this.setBoth(x, y);
        return;
      }
      if (this.yHeld) this.holdY(y);
      this.hub.zoom(this, x);
    };
    const stop = () => {
      document.removeEventListener("mousemove", move);
      document.removeEventListener("mouseup", stop);
    };
    document.addEventListener("mousemove", move);
    document.addEventListener("mouseup", stop);
  }

  // The wheel scrolls the page until the plot has been clicked (or Ctrl is held): nobody gets caught while reading on.
  private onWheel(e: WheelEvent): void {
    if (this.host.dataset.active === undefined && !e.ctrlKey) {
      this.host.dataset.hint = "true";
      return;
    }
    e.preventDefault();
    const u = this.u!;
    const factor = Math.exp(e.deltaY * (e.deltaMode === 1 ? WHEEL_LINE : 1) * WHEEL_RATE);
    const box = u.over.getBoundingClientRect();
    const x = zoomed(this.x, u.posToVal(e.clientX - box.left, "x"), factor, this.xLog);
    const y = zoomed(this.y, u.posToVal(e.clientY - box.top, "y"), factor, this.yLog);
    if (this.isPlan) this.setBoth(x, y);
    else if (e.shiftKey) this.holdY(y);
    else this.hub.zoom(this, x);
  }
}
