// The page's own decoding and mapping against the numbers that the C++ side packed:
//
//     node tests/report/decode_test.mjs <dir of coast_report_sample>
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const source = resolve(dirname(fileURLToPath(import.meta.url)), "../../src/report/web/src");
const { buildSync } = createRequire(join(process.env.COAST_NODE_MODULES, "x.js"))("esbuild");

async function load(name) {
  const dir = mkdtempSync(join(tmpdir(), "coast-"));
  const outfile = join(dir, `${name}.mjs`);
  buildSync({ entryPoints: [join(source, `${name}.ts`)], outfile, bundle: true, format: "esm", nodePaths: [process.env.COAST_NODE_MODULES] });
  const module = await import(pathToFileURL(outfile).href);
  rmSync(dir, { recursive: true });
  return module;
}

const { unpack, lowerBound, nearest, visible } = await load("decode");
const { mapX, mapY } = await load("draw");
const { tickLabels, secondsOfWeek } = await load("format");

function compare(name, packed, expected, relative) {
  const values = unpack(packed);
  const magnitude = values.reduce((a, v) => a + Math.abs(v), 0);
  assert.equal(values.length, expected.n, name);
  assert.ok(Math.abs(values.reduce((a, v) => a + v, 0) - expected.sum) <= relative * magnitude + 1e-300, `${name}: sum`);
  assert.ok(Math.abs(values.at(-1) - expected.last) <= relative * Math.max(magnitude / expected.n, Math.abs(expected.last)), `${name}: last`);
}

// Every line of the page. 2^-24: rounding to 32 bit floats; abscissae are finer (3e-9 of the span) unless they are floats too.
const page = JSON.parse(readFileSync(join(process.argv[2], "report.json"), "utf8"));
const expected = JSON.parse(readFileSync(join(process.argv[2], "expected.json"), "utf8"));
const lines = page.sections.flatMap((s) => (s.panels ?? []).flatMap((p) => p.plots.flatMap((plot) => plot.lines ?? [])));
assert.equal(lines.length, expected.length);
assert.ok(lines.length > 30);
lines.forEach((line, i) => {
  assert.equal(line.label, expected[i].label);
  compare(`${line.label}, x`, line.series.x, expected[i].x, 2 ** -24);
  compare(`${line.label}, y`, line.series.y, expected[i].y, 2 ** -24);
  if (expected[i].upper) compare(`${line.label}, band`, line.series.band.upper, expected[i].upper, 2 ** -24);
});

// Binary search against a plain scan, with repeated values.
const x = Float64Array.from([0, 1, 1, 1, 2, 5, 5, 9]);
for (const v of [-1, 0, 0.5, 1, 1.4, 1.6, 2, 4.9, 5, 8, 9, 10]) {
  const scan = x.findIndex((w) => w >= v);
  assert.equal(lowerBound(x, v), scan < 0 ? x.length : scan, `lowerBound ${v}`);
  assert.equal(Math.abs(x[nearest(x, v)] - v), Math.min(...x.map((w) => Math.abs(w - v))), `nearest ${v}`);
}
assert.deepEqual(visible(x, true, 1, 5), [0, 8]);
assert.deepEqual(visible(x, true, 1.5, 1.7), [3, 5]);
assert.deepEqual(visible(x, false, 1.5, 1.7), [0, 8]);

// Axis to pixel, by hand: the lower end is at the bottom; a decade is as long as any other.
const frame = { left: 10, top: 20, width: 200, height: 100, x: { min: 0, max: 4 }, y: { min: 0.01, max: 100 }, xLog: false, yLog: true };
assert.equal(mapX(frame)(1), 60);
assert.ok(Math.abs(mapY(frame)(0.01) - 120) < 1e-9);
assert.ok(Math.abs(mapY(frame)(1) - 70) < 1e-9);
assert.ok(Number.isNaN(mapY(frame)(-1)) || mapY(frame)(0) === 1e6);

assert.deepEqual(tickLabels([-0.25, 0, 0.25], 0.25), ["\u22120.25", "0.00", "0.25"]);
assert.deepEqual(tickLabels([0, 5e-6, 1e-5], 5e-6), ["0", "0.5e\u22125", "1.0e\u22125"]);
assert.equal(secondsOfWeek(604799.5 + 1), "0.5"); // over the end of the week
console.log(`${lines.length} lines decoded`);
