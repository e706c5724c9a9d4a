// Connects the plots of a page: common zoom in x within a group, one cursor in time, the mode of dragging.
import { isEmpty, join, type EMPTY } from "./extent";
import type { Range } from "./model";

export const TIME = "time";

/** What the hub needs of a plot. */
export interface Member {
  readonly group: string; // empty: alone
  readonly isPlan: boolean;
  dataRange(): Range;
  setX(range: Range): void;
  resetView(): void;
  showCursor(x: number | null): void;
  showTime(t: number | null): void;
}

export type DragMode = "zoom" | "pan";

export class Hub {
  mode: DragMode = "zoom";
  onTime: (t: number | null) => void = () => {};
  onZoom: (range: Range | null) => void = () => {};
  private readonly members: Member[] = [];
  private readonly homes = new Map<string, Range>();

  add(member: Member): void {
    this.members.push(member);
    this.homes.delete(member.group);
  }

  private of(group: string): Member[] {
    return this.members.filter((m) => m.group === group);
  }

  /** Common extent in x of a group's data. */
  home(group: string): Range {
    let range = this.homes.get(group);
    if (range === undefined) {
      const empty: typeof EMPTY = { min: Infinity, max: -Infinity };
      range = this.of(group).reduce<Range>((r, m) => join(r, m.dataRange()), { ...empty });
      if (isEmpty(range)) range = { min: 0, max: 1 };
      if (range.max === range.min) range = { min: range.min - 0.5, max: range.max + 0.5 };
      this.homes.set(group, range);
    }
    return range;
  }

  zoom(source: Member, range: Range): void {
    const peers = source.group ? this.of(source.group) : [source];
    for (const m of peers) m.setX(range);
    if (source.group === TIME) this.onZoom(range);
  }

  reset(source: Member): void {
    for (const m of source.group ? this.of(source.group) : [source]) m.resetView();
    if (source.group === TIME) this.onZoom(null);
  }

  resetAll(): void {
    for (const m of this.members) m.resetView();
    this.onZoom(null);
  }

  /** The pointer is at x in `source`, or has left it. */
  cursor(source: Member, x: number | null): void {
    if (!source.group) return;
    for (const m of this.of(source.group)) if (m !== source) m.showCursor(x);
    if (source.group === TIME) this.time(x, source);
  }

  /** The pointer is at a time, on a time axis or on a plan. */
  time(t: number | null, source: Member): void {
    this.onTime(t);
    for (const m of this.members) {
      if (m === source) continue;
      if (m.isPlan) m.showTime(t);
      else if (source.isPlan && m.group === TIME) m.showCursor(t);
    }
  }
}
