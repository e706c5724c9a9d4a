// Builds the page from the data that it carries.
import { noteView, tableView, tileView } from "./content";
import { el } from "./dom";
import { reading, secondsOfWeek } from "./format";
import { Hub, type DragMode } from "./hub";
import type { StoredPage, StoredSection } from "./model";
import { PanelView } from "./panel";
import type { PlotView } from "./plot";
import { forgetColours } from "./tones";

const NEAR_SCREEN = "150px"; // plots this near are kept up to date; the others wait

function sectionView(section: StoredSection, hub: Hub, startOfWeek: number | null, plots: Map<Element, PlotView>): HTMLElement {
  const notes = section.notes ?? [];
  const node = el("section", { id: section.id }, el("h2", {}, section.title), section.lead && el("p", { class: "lead" }, section.lead));
  node.append(...notes.filter((n) => n.kind !== "code").map(noteView));
  node.append(...(section.tables ?? []).map(tableView));
  for (const stored of section.panels ?? []) {
    const panel = new PanelView(stored, hub, startOfWeek);
    panel.element.querySelectorAll("[data-plot]").forEach((host, i) => plots.set(host, panel.plots[i]));
    node.append(panel.element);
  }
  node.append(...notes.filter((n) => n.kind === "code").map(noteView));
  return node;
}

function contents(page: StoredPage): HTMLElement {
  const list = el("ol");
  for (const section of page.sections ?? []) {
    const inner = el("ol");
    for (const item of [...(section.tables ?? []), ...(section.panels ?? [])]) {
      if (item.title) inner.append(el("li", {}, el("a", { href: `#${item.id}` }, item.title)));
    }
    list.append(el("li", {}, el("a", { href: `#${section.id}` }, section.title), inner.children.length ? inner : null));
  }
  const details = el("details", { open: "" }, el("summary", {}, "Contents"), list);
  if (window.matchMedia("(max-width: 1100px)").matches) details.removeAttribute("open");
  return el("nav", { class: "toc", "aria-label": "contents" }, details);
}

function toolbar(hub: Hub, start: StoredPage["start"]): HTMLElement {
  const shownRange = el("output", { class: "range" });
  const time = el("output", { class: "time" });
  const reset = el("button", { type: "button", class: "reset", disabled: "" }, "Reset zoom");
  reset.addEventListener("click", () => hub.resetAll());
  hub.onZoom = (range) => {
    reset.disabled = range === null;
    const span = range ? range.max - range.min : 0;
    shownRange.textContent = range ? `${reading(range.min, span)} to ${reading(range.max, span)} s` : "";
  };
  hub.onTime = (t) => {
    const week = start && t !== null ? `, GPS week ${start.week + Math.floor((start.sow + t) / 604800)}, sow ${secondsOfWeek(start.sow + t)}` : "";
    time.textContent = t === null ? "" : `t ${t.toFixed(3)} s${week}`;
  };
  const modes = el("div", { class: "modes", role: "group", "aria-label": "what dragging does" });
  for (const mode of ["zoom", "pan"] as DragMode[]) {
    const button = el("button", { type: "button", "aria-pressed": String(mode === hub.mode) }, mode === "zoom" ? "Drag zooms" : "Drag pans");
    button.addEventListener("click", () => {
      hub.mode = mode;
      document.body.dataset.drag = mode;
      for (const b of modes.children) b.setAttribute("aria-pressed", String(b === button));
    });
    modes.append(button);
  }
  const help =
    "Drag across a plot: zoom, in time on all plots at once. Shift and drag: pan. Click a plot, then the wheel zooms (Shift and wheel: vertically; Ctrl and wheel: without the click). Double-click: back.";
  return el("div", { class: "toolbar" }, modes, reset, shownRange, time, el("span", { class: "help", title: help, tabindex: "0", role: "note", "aria-label": help }, "?"));
}

function followScreen(plots: Map<Element, PlotView>): void {
  const near = new IntersectionObserver((entries) => entries.forEach((e) => plots.get(e.target)!.setOnScreen(e.isIntersecting)), { rootMargin: NEAR_SCREEN });
  const sizes = new ResizeObserver((entries) => entries.forEach((e) => plots.get(e.target)!.resize()));
  for (const host of plots.keys()) {
    near.observe(host);
    sizes.observe(host);
  }
}

function followSections(): void {
  const links = new Map([...document.querySelectorAll<HTMLAnchorElement>(".toc a")].map((a) => [a.hash.slice(1), a]));
  const targets = [...links.keys()].map((id) => document.getElementById(id)).filter((n): n is HTMLElement => n !== null);
  const mark = () => {
    const current = targets.filter((n) => n.getBoundingClientRect().top < innerHeight * 0.35).pop();
    for (const [id, a] of links) a.classList.toggle("current", id === current?.id);
  };
  let queued = false;
  addEventListener(
    "scroll",
    () => {
      if (queued) return;
      queued = true;
      requestAnimationFrame(() => ((queued = false), mark()));
    },
    { passive: true },
  );
  mark();
}

function followColours(plots: Map<Element, PlotView>): void {
  const redraw = () => {
    forgetColours();
    for (const p of plots.values()) p.redrawNow();
  };
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  window.addEventListener("beforeprint", () => {
    document.documentElement.classList.add("print");
    redraw();
  });
  window.addEventListener("afterprint", () => {
    document.documentElement.classList.remove("print");
    redraw();
  });
}

function main(): void {
  const page = JSON.parse(document.getElementById("page-data")!.textContent!) as StoredPage;
  const startOfWeek = page.start?.sow ?? null;
  const hub = new Hub();
  const plots = new Map<Element, PlotView>();
  const sections = (page.sections ?? []).map((s) => sectionView(s, hub, startOfWeek, plots));
  const head = el("header", {}, el("h1", {}, page.title), page.subtitle && el("p", { class: "subtitle" }, page.subtitle));
  if (page.start) head.append(el("p", { class: "start" }, `Start ${page.start.text}, GPS week ${page.start.week}, second of week ${secondsOfWeek(page.start.sow)}`));
  const tiles = el("div", { class: "tiles" }, ...(page.tiles ?? []).map(tileView));
  const main = el("main", {}, head, tiles, ...(plots.size ? [toolbar(hub, page.start)] : []), ...sections);
  if (page.footer) main.append(el("footer", {}, page.footer));
  document.getElementById("page")!.append(contents(page), main);
  followScreen(plots);
  followSections();
  followColours(plots);
  document.documentElement.dataset.ready = "true";
}

main();
