// Whether the page shows its words whole: text drawn on canvases, tables, tiles and headings, on screens of several widths.

/** Runs in the page before its scripts: notes each text that a canvas draws beyond the canvas or beyond its clip. */
export function noteCutText() {
  const kind = CanvasRenderingContext2D.prototype;
  const clips = new WeakMap(); // canvas context -> stack of clips, the present one last
  const asked = new WeakMap(); // the rectangle last put into the path
  window.cutText = new Map(); // of each canvas
  const stack = (ctx) => {
    if (!clips.has(ctx)) clips.set(ctx, [null]);
    return clips.get(ctx);
  };
  const around = (name, before) => {
    const original = kind[name];
    kind[name] = function (...given) {
      before(this, given);
      return original.apply(this, given);
    };
  };
  const inPixels = (ctx, [x, y, width, height]) => {
    const m = ctx.getTransform();
    const corners = [[x, y], [x + width, y], [x, y + height], [x + width, y + height]].map(([a, b]) => [m.a * a + m.c * b + m.e, m.b * a + m.d * b + m.f]);
    const [xs, ys] = [corners.map((c) => c[0]), corners.map((c) => c[1])];
    return { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
  };
  around("save", (ctx) => stack(ctx).push(stack(ctx).at(-1)));
  around("restore", (ctx) => stack(ctx).length > 1 && stack(ctx).pop());
  around("rect", (ctx, given) => asked.set(ctx, inPixels(ctx, given)));
  around("clip", (ctx) => (stack(ctx)[stack(ctx).length - 1] = asked.get(ctx) ?? null));
  around("clearRect", (ctx) => window.cutText.set(ctx.canvas, new Set())); // drawn anew
  around("fillText", (ctx, [text, x, y]) => {
    if (text === "") return; // a tick without its value
    const size = ctx.measureText(text);
    const box = inPixels(ctx, [x - size.actualBoundingBoxLeft, y - size.actualBoundingBoxAscent, size.actualBoundingBoxLeft + size.actualBoundingBoxRight, size.actualBoundingBoxAscent + size.actualBoundingBoxDescent]);
    const room = stack(ctx).at(-1) ?? { left: 0, top: 0, right: ctx.canvas.width, bottom: ctx.canvas.height };
    const away = box.right < room.left || box.left > room.right || box.bottom < room.top || box.top > room.bottom;
    if (away && stack(ctx).at(-1) !== null) return; // of a place that the view does not show
    const over = Math.max(room.left - box.left, box.right - room.right, room.top - box.top, box.bottom - room.bottom);
    if (over > 1.5) window.cutText.get(ctx.canvas)?.add(`"${text}" by ${over.toFixed(0)} px`);
  });
}

/** Draws every plot at the width of the window, and names what is cut: a list of sentences. */
export async function cutAt(page, width, frames) {
  await page.setViewportSize({ width, height: 900 });
  await frames(page, 8);
  for (const plot of await page.locator("[data-plot]").all()) {
    await plot.scrollIntoViewIfNeeded();
    await frames(page, 2);
  }
  return page.evaluate((wide) => {
    const found = [];
    for (const [canvas, texts] of window.cutText) {
      const panel = canvas.closest("[data-panel]")?.dataset.panel;
      if (panel && canvas.isConnected) for (const text of texts) found.push(`${panel}: ${text} cut`);
    }
    const tooWide = (node) => node.scrollWidth > node.clientWidth + 1;
    if (tooWide(document.documentElement)) found.push("the page scrolls sideways");
    for (const node of document.querySelectorAll(".tile-value, .tile-label, h1, h2, h3, h4, .note p, .legend")) {
      if (tooWide(node)) found.push(`"${node.textContent}" cut`);
    }
    // Narrow screens scroll a wide table within its frame.
    for (const frame of document.querySelectorAll(".table-frame")) {
      if (wide && tooWide(frame)) found.push(`table ${frame.parentElement.id}: ${frame.scrollWidth} px in ${frame.clientWidth}`);
      const heads = [...frame.querySelectorAll("th")].map((head) => head.textContent).filter((text) => text !== "");
      if (wide && new Set(heads).size < heads.length) found.push(`table ${frame.parentElement.id}: a heading is repeated: ${heads.join(", ")}`);
    }
    return found.map((text) => `at ${innerWidth} px: ${text}`);
  }, width >= 1400);
}
