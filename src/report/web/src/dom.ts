// Elements in one line. Text is set as text, never as markup.

type Child = Node | string | null | undefined | false;

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  for (const child of children) if (child) node.append(child);
  return node;
}

/** A patch of colour beside a label. */
export function swatch(toneName: string, kind: string): HTMLElement {
  const node = el("span", { class: `swatch swatch-${kind}`, "aria-hidden": "true" });
  node.style.setProperty("--c", `var(--tone-${toneName})`);
  return node;
}
