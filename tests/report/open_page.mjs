// Opens a report from disk in headless Chromium, without a network, and checks that it works:
//
//     node tests/report/open_page.mjs <report.html> [screenshot_dir]
//
// Every plot has drawn its data, no text is cut on narrow and wide screens, the console is free of errors, nothing is fetched, zoom, pan and reset work and are quick.
// Exit status 0 passed, 1 failed (each failure on a line), 2 wrong call, 77 no browser here.
// playwright-core is taken from $COAST_NODE_MODULES, else from a build tree of this project.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { cutAt, noteCutText } from "./cut_text.mjs";

const LEAST_INK = 30; // canvas pixels that differ between a plot with and without its curves
const SLOWEST_ZOOM_MS = 400; // median of a wheel step, event to frame; an idle machine needs about 30, a loaded one must not fail
const MOST_BYTES = 15e6;
const WIDTHS = [390, 1024, 1440]; // a phone, a tablet, a desk; the last stays

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const failures = [];
const check = (condition, text) => condition || failures.push(text);

function loadPlaywright() {
  const builds = readdirSync(root).filter((name) => name.startsWith("build"));
  const places = [process.env.COAST_NODE_MODULES, ...builds.map((b) => join(root, b, "src/report/web/node_modules")), join(root, "src/report/web/node_modules")];
  const place = places.find((p) => p && existsSync(join(p, "playwright-core")));
  if (!place) throw new Error("playwright-core not found; build the project or set COAST_NODE_MODULES");
  return createRequire(join(place, "x.js"))("playwright-core");
}

function findChromium() {
  try {
    return execFileSync("sh", ["-c", "command -v chromium || command -v chromium-browser || command -v google-chrome"], { encoding: "utf8" }).trim();
  } catch {
    return null;
  }
}

/** Pixels of the plot's canvas that differ from those at the last call. A copy is read, so that the page's canvas stays fast. */
const changedPixels = (plot) =>
  plot.evaluate((host) => {
    const canvas = host.querySelector("canvas");
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const now = new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
    const before = host.pixelsBefore;
    host.pixelsBefore = now;
    return before ? now.reduce((count, v, i) => count + (v !== before[i] ? 1 : 0), 0) : 0;
  });

const range = (plot) => plot.evaluate((host) => ["xMin", "xMax", "yMin", "yMax"].map((k) => Number(host.dataset[k])));
const frames = (page, n = 2) => page.evaluate(async (count) => {
  for (let i = 0; i < count; i++) await new Promise((done) => requestAnimationFrame(() => done()));
}, n);

async function settle(page, plot) {
  await plot.scrollIntoViewIfNeeded();
  await plot.locator("canvas").waitFor({ timeout: 10000 });
  await frames(page, 3);
}

/** Draws each panel with and without its curves: the difference is the data's ink. */
async function checkInk(page) {
  const panels = page.locator("[data-panel]");
  for (let i = 0; i < (await panels.count()); i++) {
    const panel = panels.nth(i);
    const name = await panel.getAttribute("data-panel");
    const plots = await panel.locator("[data-plot]").all();
    for (const plot of plots) {
      await settle(page, plot);
      await changedPixels(plot);
    }
    const buttons = await panel.locator(".legend button").all();
    const toggle = async () => {
      for (const b of buttons) await b.evaluate((node) => node.click());
    };
    await toggle();
    for (const [k, plot] of plots.entries()) {
      await settle(page, plot);
      const ink = await changedPixels(plot);
      check(ink >= LEAST_INK, `${name}, plot ${k + 1}: ${ink} pixels of data, expected at least ${LEAST_INK}`);
    }
    await toggle();
  }
}

async function drag(page, box, from, to, shift = false) {
  const at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
  if (shift) await page.keyboard.down("Shift");
  await page.mouse.move(...at(from));
  await page.mouse.down();
  await page.mouse.move(...at([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2]));
  await page.mouse.move(...at(to));
  await page.mouse.up();
  if (shift) await page.keyboard.up("Shift");
  await frames(page);
}

const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;

/** Median time from a wheel event to the frame that shows it, ms; taken inside the page, so that the test's own traffic is not in it. */
const timeWheel = (over) =>
  over.evaluate(async (node) => {
    const box = node.getBoundingClientRect();
    const times = [];
    for (let i = 0; i < 30; i++) {
      const began = performance.now();
      const where = { clientX: box.x + box.width / 2, clientY: box.y + box.height / 2, bubbles: true, cancelable: true };
      node.dispatchEvent(new WheelEvent("wheel", { ...where, deltaY: i < 15 ? -120 : 120 }));
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
      times.push(performance.now() - began);
    }
    return times.sort((u, v) => u - v)[15];
  });

/** Zooms, pans, wheels and resets one plot by the mouse, and follows the axis; returns the median of a wheel step. */
async function checkZoom(page, plot, name, linked) {
  await settle(page, plot);
  const over = plot.locator(".u-over");
  await plot.evaluate((host) => host.scrollIntoView({ block: "center", behavior: "instant" }));
  await frames(page);
  const box = await over.boundingBox();
  const [a, b] = await range(plot);
  const span = b - a;

  await drag(page, box, [0.25, 0.5], [0.5, 0.52]);
  const [za, zb] = await range(plot);
  const pixel = span / box.width;
  check(near(za, a + 0.25 * span, 2 * pixel) && near(zb, a + 0.5 * span, 2 * pixel), `${name}: drag gave ${za} to ${zb} of ${a} to ${b}`);
  if (linked) {
    await settle(page, linked);
    const [la, lb] = await range(linked);
    check(near(la, za, 1e-6 * span) && near(lb, zb, 1e-6 * span), `${name}: another time axis did not follow`);
    await plot.evaluate((host) => host.scrollIntoView({ block: "center", behavior: "instant" }));
    await frames(page);
  }

  await drag(page, box, [0.6, 0.5], [0.4, 0.5], true);
  const [pa, pb] = await range(plot);
  check(near(pa - za, 0.2 * (zb - za), 0.02 * (zb - za)) && near(pb - pa, zb - za, 1e-6 * span), `${name}: shift-drag gave ${pa} to ${pb} of ${za} to ${zb}`);

  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  for (let i = 0; i < 20; i++) {
    await page.mouse.wheel(0, i < 10 ? -120 : 120);
    await frames(page, 1);
  }
  const [wa, wb] = await range(plot);
  check(near(wa, pa, 1e-3 * span) && near(wb, pb, 1e-3 * span), `${name}: ten wheel steps in and out gave ${wa} to ${wb} of ${pa} to ${pb}`);

  const step = await timeWheel(over);
  await page.mouse.dblclick(box.x + box.width / 2, box.y + box.height / 2);
  await frames(page);
  const [ra, rb] = await range(plot);
  check(near(ra, a, 1e-9 * span) && near(rb, b, 1e-9 * span), `${name}: double-click gave ${ra} to ${rb}, expected ${a} to ${b}`);
  return step;
}

async function checkReadout(page, plot, name) {
  const box = await plot.locator(".u-over").boundingBox();
  await page.mouse.move(box.x + box.width * 0.37, box.y + box.height * 0.5);
  await frames(page);
  const text = await plot.evaluate((host) => host.parentElement.querySelector(".readout").textContent);
  check(/t [\u2212\d.]+ s/.test(text), `${name}: the cursor reads "${text}"`);
  const time = await page.locator(".toolbar .time").textContent();
  check(time.length > 0, `${name}: the toolbar shows no time`);
}

async function checkPlan(page, plan) {
  const [a, b, c, d] = await range(plan);
  const box = await plan.locator(".u-over").boundingBox();
  check(near(((b - a) / box.width) * (box.height / (d - c)), 1, 0.01), "plan: a metre is not as long in x as in y");
}

async function screenshots(page, dir) {
  mkdirSync(dir, { recursive: true });
  const shot = async (name, locator) => (locator ?? page).screenshot({ path: join(dir, `${name}.png`) });
  await page.evaluate(() => window.scrollTo({ top: 0, behavior: "instant" }));
  await frames(page, 4);
  await shot("top");
  const still = await page.addStyleTag({ content: ".toolbar { position: static !important; }" });
  for (const block of await page.locator("[data-panel], .table").all()) {
    await block.scrollIntoViewIfNeeded();
    await frames(page, 4);
    await shot(await block.getAttribute("id"), block);
  }
  await still.evaluate((node) => node.remove());
  for (const [name, media, size] of [["dark", { colorScheme: "dark" }, null], ["narrow", { colorScheme: "light" }, { width: 430, height: 900 }]]) {
    await page.emulateMedia(media);
    if (size) await page.setViewportSize(size);
    for (const [part, top] of [["top", 0], ["below", 2200]]) {
      await page.evaluate((y) => window.scrollTo({ top: y, behavior: "instant" }), top);
      await frames(page, 8);
      await shot(`${name}-${part}`);
    }
  }
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.pdf({ path: join(dir, "print.pdf"), format: "A4", margin: { top: "14mm", bottom: "14mm", left: "12mm", right: "12mm" } });
}

async function run(file, dir) {
  const executablePath = findChromium();
  if (!executablePath) {
    console.log("skipped: no chromium on this machine");
    return 77;
  }
  check(statSync(file).size < MOST_BYTES, `the page has ${statSync(file).size} bytes, expected below ${MOST_BYTES}`);
  const browser = await loadPlaywright().chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  try {
    const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
    page.on("console", (m) => ["error", "warning"].includes(m.type()) && failures.push(`console: ${m.text()} (${m.location().url.slice(-40)}:${m.location().lineNumber}:${m.location().columnNumber})`));
    page.on("pageerror", (e) => failures.push(`exception: ${e.message}`));
    await page.route("**/*", (route) => {
      if (route.request().url().startsWith("file:")) return route.continue();
      failures.push(`network: ${route.request().url().slice(0, 200)}`);
      return route.abort();
    });
    await page.addInitScript(noteCutText);
    const began = performance.now();
    await page.goto(pathToFileURL(resolve(file)).href);
    await page.locator("html[data-ready=true]").waitFor({ timeout: 30000, state: "attached" });
    const loaded = performance.now() - began;
    for (const width of WIDTHS) failures.push(...(await cutAt(page, width, frames)));
    await checkInk(page);

    const timed = await page.locator("[data-plot]:not(:has(.place))").all();
    const linkedPlots = [];
    for (const plot of timed) if (await plot.evaluate((h) => h.dataset.group === "time")) linkedPlots.push(plot);
    let zoom = NaN;
    if (linkedPlots.length > 0) {
      zoom = await checkZoom(page, linkedPlots[0], "first time axis", linkedPlots.at(-1));
      check(zoom < SLOWEST_ZOOM_MS, `a wheel step takes ${zoom.toFixed(0)} ms, expected below ${SLOWEST_ZOOM_MS}`);
      await checkReadout(page, linkedPlots[0], "first time axis");
    }
    const plans = await page.locator("[data-plot][data-group=plan]").all();
    for (const plan of plans) {
      await settle(page, plan);
      await checkPlan(page, plan);
    }
    if (dir) await screenshots(page, dir);
    const plots = await page.locator("[data-plot]").count();
    console.log(`${plots} plots, ${(statSync(file).size / 1e6).toFixed(2)} MB, opened in ${loaded.toFixed(0)} ms, wheel step ${zoom.toFixed(0)} ms`);
  } finally {
    await browser.close();
  }
  for (const f of failures) console.log(`FAILED ${f}`);
  return failures.length ? 1 : 0;
}

if (process.argv.length < 3 || process.argv.length > 4) {
  console.error("usage: node open_page.mjs <report.html> [screenshot_dir]");
  process.exit(2);
}
process.exit(await run(process.argv[2], process.argv[3]));
