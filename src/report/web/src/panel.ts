// A figure: title, caption, one legend for all its plots, the plots in a stack or a grid.
import { decodePlot, type Content } from "./decode";
import { el, swatch } from "./dom";
import { WIDE } from "./draw";
import type { Hub } from "./hub";
import type { StoredPanel, StoredPlot } from "./model";
import { PlotView } from "./plot";
import { ToneChooser } from "./tones";

const USUAL_HEIGHT = 260;
const X_AXIS_HEIGHT = 52; // a stacked plot with the common axis is higher by it

interface Entry {
  label: string;
  tone: string;
  kind: string;
  band: string;
}

export class PanelView {
  readonly element: HTMLElement;
  readonly plots: PlotView[] = [];
  private readonly hidden = new Set<string>();

  constructor(stored: StoredPanel, hub: Hub, startOfWeek: number | null) {
    const chooser = new ToneChooser();
    const plots = stored.plots ?? [];
    const contents = plots.map((p) => decodePlot(p, (label, tone) => chooser.choose(label, tone)));
    for (const p of plots) for (const l of p.lines ?? []) if (l.hidden) this.hidden.add(l.label);

    const columns = stored.columns ?? 1;
    const grid = el("div", { class: columns > 1 ? "plots grid" : "plots" });
    grid.style.setProperty("--columns", String(columns));
    const stacked = columns === 1 && plots.length > 1;
    plots.forEach((plot, i) => {
      grid.append(this.cell(plot, contents[i], hub, startOfWeek, !stacked || i === plots.length - 1, stacked));
    });
    this.element = el(
      "figure",
      { class: "panel", id: stored.id, "data-panel": stored.id },
      el("h3", {}, stored.title, this.anchor(stored.id)),
      stored.caption && el("figcaption", {}, stored.caption),
      this.legend(contents),
      grid,
      this.omissions(contents),
    );
  }

  private anchor(id: string): HTMLElement {
    return el("a", { class: "anchor", href: `#${id}`, "aria-label": "link to this figure" }, "#");
  }

  private cell(plot: StoredPlot, content: Content, hub: Hub, startOfWeek: number | null, xLabels: boolean, stacked: boolean): HTMLElement {
    const canvas = el("div", { class: "plot", "data-plot": "" });
    const readout = el("div", { class: "readout" });
    const height = (plot.height_px || USUAL_HEIGHT) + (stacked && xLabels ? X_AXIS_HEIGHT : 0);
    const shown = (label: string) => !this.hidden.has(label);
    this.plots.push(new PlotView(canvas, readout, plot, content, hub, { height, xLabels, startOfWeek, shown }));
    const head = el("div", { class: "cell-head" }, plot.title && el("h4", {}, plot.title), readout);
    return el("div", { class: "cell" }, head, canvas);
  }

  private legend(contents: Content[]): HTMLElement | null {
    const entries = new Map<string, Entry>();
    for (const content of contents) {
      for (const c of content.curves) {
        const kind = c.kind === "points" ? "points" : c.size > WIDE ? "band" : c.style;
        if (!entries.has(c.label)) entries.set(c.label, { label: c.label, tone: c.tone, kind, band: c.bandLabel });
      }
      for (const b of content.bars) entries.set(b.label, { label: b.label, tone: b.tone, kind: "bar", band: "" });
      for (const b of content.boxes) entries.set(b.label, { label: b.label, tone: b.tone, kind: "bar", band: "" });
    }
    if (entries.size === 0) return null;
    const legend = el("div", { class: "legend", role: "group", "aria-label": "curves; click to switch one on or off, shift-click for it alone" });
    const buttons: [string, HTMLButtonElement][] = [];
    const show = () => {
      for (const [label, button] of buttons) button.setAttribute("aria-pressed", String(!this.hidden.has(label)));
      for (const p of this.plots) p.refresh();
    };
    for (const e of entries.values()) {
      const button = el("button", { type: "button", "aria-pressed": String(!this.hidden.has(e.label)) }, swatch(e.tone, e.kind), e.label);
      if (e.band) button.append(swatch(e.tone, "band"), e.band);
      button.addEventListener("click", (event) => {
        this.toggle(e.label, event.shiftKey, [...entries.keys()]);
        show();
      });
      buttons.push([e.label, button]);
      legend.append(button);
    }
    return legend;
  }

  private toggle(label: string, alone: boolean, all: string[]): void {
    if (!alone) {
      if (!this.hidden.delete(label)) this.hidden.add(label);
      return;
    }
    const isAlone = all.every((other) => this.hidden.has(other) === (other !== label));
    this.hidden.clear();
    if (!isAlone) for (const other of all) if (other !== label) this.hidden.add(other);
  }

  private omissions(contents: Content[]): HTMLElement | null {
    const parts = contents.flatMap((c) => c.curves.filter((k) => k.series.notFinite > 0).map((k) => `${k.label}: ${k.series.notFinite}`));
    return parts.length ? el("p", { class: "omission" }, `Values that are not finite and not drawn: ${parts.join(", ")}.`) : null;
  }
}
