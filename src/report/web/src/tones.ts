// Colours live in style.css as --tone-<name>, for light, dark and print; the canvas reads them from there.

const PALETTE = ["p1", "p2", "p3", "p4", "p5", "p6"];

let cache = new Map<string, string>();

export function forgetColours(): void {
  cache = new Map();
}

/** The value of a custom property, e.g. "--ink" or "--tone-fixed". */
export function colour(property: string): string {
  let value = cache.get(property);
  if (value === undefined) {
    value = getComputedStyle(document.documentElement).getPropertyValue(property).trim();
    cache.set(property, value);
  }
  return value;
}

export const tone = (name: string): string => colour(`--tone-${name}`);

/** Resolves "auto": within a panel every label keeps one colour of the palette. */
export class ToneChooser {
  private readonly chosen = new Map<string, string>();

  choose(label: string, stated?: string): string {
    if (stated !== undefined && stated !== "auto") return stated;
    let name = this.chosen.get(label);
    if (name === undefined) {
      name = PALETTE[this.chosen.size % PALETTE.length];
      this.chosen.set(label, name);
    }
    return name;
  }
}
