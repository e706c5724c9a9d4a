// Everything but the plots: tiles, tables, notes.
import { el } from "./dom";
import type { Note, StoredCell, StoredTable, Tile, Verdict } from "./model";

const SIGNS: Record<Verdict, [string, string]> = {
  none: ["", ""],
  good: ["\u2713", "good"],
  warn: ["!", "to be looked at"],
  bad: ["\u2715", "bad"],
};
const LONG_TABLE = 16; // rows; beyond it the table scrolls within its frame

function sign(verdict: Verdict): HTMLElement | null {
  const [mark, meaning] = SIGNS[verdict];
  return mark ? el("span", { class: `sign sign-${verdict}`, title: meaning, role: "img", "aria-label": meaning }, mark) : null;
}

function shares(tile: Tile): HTMLElement | null {
  if (!tile.shares?.length) return null;
  const bar = el("div", { class: "shares", role: "img", "aria-label": tile.shares.map((s) => `${s.label} ${(100 * s.fraction).toFixed(1)} %`).join(", ") });
  for (const s of tile.shares) {
    const part = el("span", { title: `${s.label} ${(100 * s.fraction).toFixed(1)} %` });
    part.style.cssText = `flex:${Math.max(0, s.fraction)};background:var(--tone-${s.tone})`;
    bar.append(part);
  }
  return bar;
}

export function tileView(tile: Tile): HTMLElement {
  const verdict = tile.verdict ?? "none";
  const node = tile.section ? el("a", { href: `#${tile.section}` }) : el("div");
  node.className = `tile tile-${verdict}`;
  const long = tile.value.length > 9 ? " long" : "";
  node.append(el("div", { class: "tile-label" }, tile.label, sign(verdict)));
  node.append(el("div", { class: `tile-value${long}` }, tile.value, tile.unit ? el("span", { class: "unit" }, ` ${tile.unit}`) : null));
  const bar = shares(tile);
  if (bar) node.append(bar);
  if (tile.explanation) node.append(el("p", {}, tile.explanation));
  return node;
}

const textOf = (cell: StoredCell): string => (typeof cell === "string" ? cell : cell.text);

function row(table: StoredTable, cells: StoredCell[]): HTMLElement {
  const node = el("tr");
  cells.forEach((cell, i) => {
    const verdict = typeof cell === "string" ? "none" : cell.verdict;
    const numeric = table.columns?.[i]?.numeric !== false;
    node.append(el("td", { class: `${numeric ? "number" : ""} cell-${verdict}` }, textOf(cell), sign(verdict)));
  });
  return node;
}

/** Order by one column: numbers by value, absent ones last, text by alphabet. */
function ordered(rows: StoredCell[][], column: number, numeric: boolean, falling: boolean): StoredCell[][] {
  const key = (r: StoredCell[]) => {
    const value = parseFloat(textOf(r[column]).replace("\u2212", "-"));
    return Number.isNaN(value) ? (falling ? -Infinity : Infinity) : value;
  };
  const sense = falling ? -1 : 1;
  const compare = numeric
    ? (a: StoredCell[], b: StoredCell[]) => Math.sign(key(a) - key(b))
    : (a: StoredCell[], b: StoredCell[]) => textOf(a[column]).localeCompare(textOf(b[column]), "en");
  return [...rows].sort((a, b) => sense * (compare(a, b) || 0));
}

export function tableView(table: StoredTable): HTMLElement {
  const rows = table.rows ?? [];
  const body = el("tbody", {}, ...rows.map((r) => row(table, r)));
  const head = el("tr");
  (table.columns ?? []).forEach((column, i) => {
    const cell = el("th", { scope: "col", class: column.numeric !== false ? "number" : "" });
    const button = el("button", { type: "button", title: "order by this column" }, column.label, column.unit && " ", column.unit && el("span", { class: "unit" }, `[${column.unit}]`));
    let falling = column.numeric === false;
    button.addEventListener("click", () => {
      falling = !falling;
      for (const other of head.children) other.removeAttribute("aria-sort");
      cell.setAttribute("aria-sort", falling ? "descending" : "ascending");
      body.replaceChildren(...ordered(rows, i, column.numeric !== false, falling).map((r) => row(table, r)));
    });
    cell.append(button);
    head.append(cell);
  });
  const frame = el("div", { class: rows.length > LONG_TABLE ? "table-frame long" : "table-frame", tabindex: "0" });
  frame.append(el("table", {}, el("thead", {}, head), body));
  return el("div", { class: "table", id: table.id }, table.title && el("h3", {}, table.title), table.caption && el("p", { class: "caption" }, table.caption), frame);
}

export function noteView(note: Note): HTMLElement {
  if (note.kind === "code") return el("details", { class: "code" }, el("summary", {}, note.title ?? ""), el("pre", {}, note.text));
  const warning = note.kind === "warning";
  return el(
    "div",
    { class: warning ? "note note-warning" : "note" },
    warning && sign("warn"),
    el("div", {}, note.title && el("strong", {}, note.title), el("p", {}, note.text)),
  );
}
