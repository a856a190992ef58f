// The page in headless Chromium: four cases of the paper and five other scenes load without a message, the mechanism follows the
// time slider to a fraction of a pixel, charts follow, and the built page is that of the sources.
//
// LOOSELINK names the program, CHROMIUM the browser.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const ROOT = resolve(import.meta.dirname, "../../../..");
const PROGRAM = process.env.LOOSELINK ?? resolve(ROOT, process.env.CARGO_TARGET_DIR ?? "target", "debug/looselink");
const BROWSER = process.env.CHROMIUM ?? "/usr/bin/chromium";
const VIEWPORT = { width: 1280, height: 900 };
const LOAD_SCENES = [
  { name: "case1", scene: "3rrr/case1.toml", set: ["simulation.duration=1.0"] },
  { name: "case2", scene: "3rrr/case2.toml", set: ["simulation.duration=0.2"] },
  { name: "case3", scene: "3rrr/case3.toml", set: ["simulation.duration=0.1"], least: 25 },
  { name: "case4", scene: "3rrr/case4.toml", set: ["simulation.duration=0.1"], least: 25 },
  { name: "slider", scene: "slider-crank/both.toml", set: ["simulation.duration=0.05"] },
  { name: "yoke", scene: "scotch-yoke.toml", set: [] },
  { name: "maxwell", scene: "maxwell.toml", set: [] },
  { name: "disc", scene: "driven-disc.toml", set: [] },
  { name: "crane", scene: "../crates/cli/templates/crane.toml", set: ["simulation.duration=2.0"] },
  { name: "pendulum", scene: "../crates/cli/templates/pendulum.toml", set: [] },
  { name: "spring", scene: "../verify/scenes/everything.toml", set: ["simulation.duration=0.02"] },
  { name: "static", scene: "cantilever-static.toml", set: [], least: 0 },
];

let browser;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "looselink-viewer-"));
  browser = await chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Runs a scene, with all channels or some, and returns its folder. */
function run(name, scene, set, recorded = ["*"]) {
  const out = join(folder, name);
  const overrides = [...set, `output.channels=${JSON.stringify(recorded)}`].flatMap((s) => ["--set", s]);
  execFileSync(PROGRAM, ["run", join(ROOT, "scenes", scene), "--out", out, "--view", "--quiet", ...overrides], { stdio: "ignore" });
  return out;
}

/** Columns of channels.csv, or of channels.jsonl. */
function channels(out) {
  try {
    const [head, ...rows] = readFileSync(join(out, "channels.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
    const names = head.map((h) => h.split(" [")[0]);
    return Object.fromEntries(names.map((name, i) => [name, rows.map((row) => Number(row[i]))]));
  } catch {
    const rows = readFileSync(join(out, "channels.jsonl"), "utf8").trim().split("\n").map((row) => JSON.parse(row));
    return Object.fromEntries(Object.keys(rows[0]).map((key) => [key.split(" [")[0], rows.map((row) => row[key])]));
  }
}

/** Opens a page; everything that it or the browser says is collected. */
async function open(file, viewport = VIEWPORT) {
  const page = await browser.newPage({ viewport });
  const messages = [];
  page.on("console", (message) => messages.push(message.text()));
  page.on("pageerror", (error) => messages.push(String(error)));
  page.on("request", (request) => request.url().startsWith("file:") || request.url().startsWith("data:") || messages.push(`request: ${request.url()}`));
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("html[data-ready]");
  return { page, messages };
}

const seek = (page, t) =>
  page.evaluate((t) => {
    const slider = document.getElementById("time");
    slider.value = String(t);
    slider.dispatchEvent(new Event("input"));
    return Number(slider.value);
  }, t);

/** How far symbols of rigid bodies and of revolute joints are on the screen from where the channels have them at a row [pixels]. */
const distances = async (page, columns, row) => {
  const symbols = await page.evaluate(() => {
    const at = (e) => (({ e: x, f: y }) => [x, y])(e.getScreenCTM());
    const { a, b, c, d, e, f } = document.getElementById("world").getScreenCTM();
    return {
      plane: [a, b, c, d, e, f],
      bodies: [...document.querySelectorAll(".run g.rigid")].map((g) => [g.dataset.body, at(g)]),
      joints: [...document.querySelectorAll(".run g.joint[transform]")].map((g) => [`points.${g.dataset.bearing}`, at(g)]),
    };
  });
  const [a, b, c, d, e, f] = symbols.plane;
  const distance = ([name, [px, py]]) => {
    const [x, y] = [columns[`${name}.x`][row], columns[`${name}.y`][row]];
    return Math.hypot(a * x + c * y + e - px, b * x + d * y + f - py);
  };
  const known = ([name]) => columns[`${name}.x`];
  // the frame of a link is at its start; its channels are those of its centre
  const frames = symbols.bodies.filter(([name]) => known([name]) && !columns[`points.${name}.start.x`]);
  return [...frames, ...symbols.joints.filter(known)].map(distance);
};

/** Frames in a second of playing. */
const frames = (page) =>
  page.evaluate(
    () =>
      new Promise((done) => {
        let frames = 0;
        const start = performance.now();
        const count = () => (++frames, performance.now() - start < 1000 ? requestAnimationFrame(count) : done((1000 * frames) / (performance.now() - start)));
        requestAnimationFrame(count);
      }),
  );

for (const { name, scene, set, least = 1 } of LOAD_SCENES) {
  test(`${scene} loads without a message and moves with the slider`, async (context) => {
    const out = run(name, scene, set);
    const file = join(out, "view.html");
    const { page, messages } = await open(file);
    const columns = channels(out);
    const rows = columns.t.length;
    const before = await page.evaluate(() => document.getElementById("world").innerHTML);
    let [worst, compared] = [0, 0];
    for (const row of [1, Math.floor(rows / 3), Math.floor(rows / 2), rows - 2, rows - 1].filter((r) => r > 0)) {
      await seek(page, columns.t[row]);
      const all = await distances(page, columns, row);
      worst = Math.max(worst, ...all);
      compared += all.length;
    }
    // what docs/view.md promises, and rounding of screen coordinates to single precision
    const allowed = 5e-5 * (await page.evaluate(() => {
      const { width, height } = document.getElementById("mechanism").viewBox.baseVal;
      return Math.max(width, height) * document.getElementById("world").getScreenCTM().a;
    })) + 1e-3;
    assert.ok(worst <= allowed, `a symbol is ${worst} pixels off, more than ${allowed}`);
    assert.ok(compared >= least, `only ${compared} places were compared`);
    const later = await page.evaluate(() => document.getElementById("world").innerHTML);
    assert.notEqual(before, later, "the mechanism stands still");
    // charts follow: the line that shows the time stands where the chart has that time
    await seek(page, columns.t[Math.floor(rows / 2)]);
    const lines = await page.evaluate(() =>
      [...document.querySelectorAll(".now")].map((line) => {
        const over = line.parentElement.getBoundingClientRect();
        return (line.getBoundingClientRect().left - over.left) / over.width;
      }),
    );
    assert.ok(lines.length > 0, "there is no chart");
    const share = (columns.t[Math.floor(rows / 2)] - columns.t[0]) / (columns.t[rows - 1] - columns.t[0]);
    for (const line of lines) assert.ok(Math.abs(line - share) < 0.02, `the chart shows ${line} of the time, not ${share}`);
    // frames while it plays
    await page.click("#play");
    const rate = await frames(page);
    context.diagnostic(`${compared} places at most ${worst.toFixed(3)} px off; ${rate.toFixed(0)} frames/s; ${(statSync(file).size / 1e6).toFixed(2)} MB`);
    assert.deepEqual(messages, []);
    await page.close();
  });
}

test("charts of 100,000 rows follow, zoom and play", async (context) => {
  const set = ["simulation.duration=10.0", "integrator.step=1e-4", "output.interval=1e-4"];
  const out = run("long", "pendulum.toml", set, ["points.rod.bob.*", "pivot.force"]);
  const { page, messages } = await open(join(out, "view.html"));
  const columns = channels(out);
  assert.equal(columns.t.length, 100001);
  /** Where the line that shows the time stands in the first chart, as a part of its width. */
  const line = () =>
    page.evaluate(() => {
      const line = document.querySelector(".now");
      const over = line.parentElement.getBoundingClientRect();
      return (line.getBoundingClientRect().left - over.left) / over.width;
    });
  await seek(page, columns.t[50000]);
  assert.ok(Math.abs((await line()) - 0.5) < 0.005);
  // a drag from 0.4 to 0.6 of the width shows 4 s to 6 s: the time 5.5 s then stands at three quarters
  const box = await page.locator(".u-over").first().boundingBox();
  const [from, to] = [0.4, 0.6].map((part) => box.x + part * box.width);
  await page.mouse.move(from, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(to, box.y + 20, { steps: 5 });
  await page.mouse.up();
  await seek(page, columns.t[55000]);
  assert.ok(Math.abs((await line()) - 0.75) < 0.02, `the line stands at ${await line()}`);
  await page.click("#play");
  const rate = await frames(page);
  context.diagnostic(`${rate.toFixed(0)} frames/s with ${columns.t.length} rows`);
  assert.deepEqual(messages, []);
  await page.close();
});

test("eccentricities are right to a thousandth of the clearance", async () => {
  const out = run("loose", "3rrr/case3.toml", ["simulation.duration=0.05"]);
  const { page } = await open(join(out, "view.html"));
  const columns = channels(out);
  // radius of the play in the picture stands for the clearance of 2e-5 m
  const [play, clearance] = [22, 2e-5];
  let worst = 0;
  for (let row = 0; row < columns.t.length; row += 7) {
    await seek(page, columns.t[row]);
    const [cx, cy] = await page.evaluate(() => {
      const journal = document.querySelector('[data-inset="B1"] .journal');
      return [Number(journal.getAttribute("cx")), Number(journal.getAttribute("cy"))];
    });
    worst = Math.max(worst, Math.hypot(cx - (play / clearance) * columns["B1.ex"][row], cy - (play / clearance) * columns["B1.ey"][row]) / play);
  }
  assert.ok(worst <= 1e-3, `${worst} of the clearance`);
  await page.close();
});

test("a ghost, a phone, the dark, the keyboard and names for screen readers", async () => {
  const out = run("both", "slider-crank/both.toml", ["simulation.duration=0.02"]);
  const ideal = run("ideal", "slider-crank/ideal.toml", ["simulation.duration=0.02"]);
  const file = join(folder, "ghost.html");
  execFileSync(PROGRAM, ["view", out, "--ghost", ideal, "-o", file]);
  const { page, messages } = await open(file, { width: 390, height: 800 });
  assert.equal(await page.locator(".ghost").count(), 1);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "it is wider than the phone");
  await page.click("#theme");
  const time = () => page.evaluate(() => Number(document.getElementById("time").value));
  // a run with a loose pin opens in mid-motion, its values have units
  assert.ok(Math.abs((await time()) - 0.01) < 1e-4, `it opens at ${await time()} s`);
  const inset = await page.evaluate(() => document.querySelector('[data-inset="slider_pin"]').closest("figure").textContent);
  assert.match(inset, /slider_pin: e = [\d.]+ [µm]m.*N/s);
  await page.focus("#mechanism");
  await page.keyboard.press("End");
  assert.ok(Math.abs((await time()) - 0.02) < 1e-9);
  await page.keyboard.press("ArrowLeft");
  assert.ok((await time()) < 0.02);
  await page.keyboard.press("Home");
  assert.equal(await time(), 0);
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.getElementById("time").value) > 0);
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, svg[role=img], section")]
      .filter((e) => !(e.getAttribute("aria-label") || e.closest("label")?.textContent.trim() || e.textContent.trim()))
      .map((e) => e.outerHTML.slice(0, 80)),
  );
  assert.deepEqual(nameless, []);
  assert.deepEqual(messages, []);
  await page.close();
});

test("a mode swings beside the pose at rest", async () => {
  const pages = join(folder, "modes");
  execFileSync(PROGRAM, ["modes", join(ROOT, "scenes/slider-crank/flexible.toml"), "--count", "1", "--view", pages], { stdio: "ignore" });
  const { page, messages } = await open(join(pages, "mode-01.html"));
  const shape = () => page.evaluate(() => [".run", ".ghost"].map((part) => document.querySelector(part).innerHTML));
  const [swung, rest] = await shape();
  // half a period after the start the mode swings to the other side
  const end = await page.evaluate(() => Number(document.getElementById("time").max));
  await seek(page, end / 8);
  const [other, still] = await shape();
  assert.notEqual(swung, other, "the mode stands still");
  assert.equal(rest, still, "the pose at rest moves");
  assert.deepEqual(messages, []);
  await page.close();
});

test("the page in the repository is the one that the sources build", () => {
  const built = join(folder, "built.html");
  execFileSync("node", ["build.mjs", built], { cwd: join(import.meta.dirname, "..") });
  assert.equal(readFileSync(built, "utf8"), readFileSync(join(import.meta.dirname, "../../assets/viewer.html"), "utf8"));
});
