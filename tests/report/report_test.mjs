// The report's page in a browser: all tests, in the order in which a reader meets the parts. tests/report/run calls it.

import {after, before, test} from "node:test";
import assert from "node:assert/strict";
import {cpSync, mkdirSync, rmSync, statSync, readdirSync, writeFileSync} from "node:fs";
import {join} from "node:path";

import {close, open_report, page, problems, requests, settle, work} from "./browser.mjs";
import {chart_tests} from "./chart_tests.mjs";
import {write_fixture} from "./make_fixture.mjs";
import {palette_tests} from "./palette_tests.mjs";
import {table_tests} from "./table_tests.mjs";
import {viewer_tests} from "./viewer_tests.mjs";

const report = join(work, "report");
const size = (file) => statSync(join(report, file)).size;
rmSync(report, {recursive: true, force: true});
mkdirSync(report, {recursive: true});
const results = write_fixture(report, 640, 360);
for (const file of ["index.html", "report.bundle.js"]) cpSync(join(work, "page", file), join(report, file));

before(() => open_report(report));
after(close);

test("the page is small: index and charts under 400 KB, 32 pictures of 640x360 under 45 MB", () => {
  const index = size("index.html") + size("report.bundle.js");
  const images = readdirSync(join(report, "images"))
    .map((file) => size(`images/${file}`))
    .sort((a, b) => b - a)
    .slice(0, 32);
  const whole = index + size("data.js") + images.reduce((a, b) => a + b, 0);
  console.log(
    `  index.html ${size("index.html")}, report.bundle.js ${size("report.bundle.js")}, data.js of ${results.cells.length} cells `
      + `${size("data.js")}, with 32 pictures ${(whole / 1e6).toFixed(1)} MB`,
  );
  assert.ok(index < 400e3, `${index} bytes`);
  assert.equal(images.length, 32);
  assert.ok(whole < 45e6, `${whole} bytes`);
});

test("the page opens with its charts drawn; in under a second with REPORT_TIMES=1", async () => {
  const times = [];
  // The best of a few: what else the machine does is not the page's doing.
  for (let i = 0; i < 5; ++i) {
    await open_report(report);
    times.push(await page.evaluate(() => performance.now()));
  }
  console.log(`  opened in ${times.map(Math.round).join(", ")} ms`);
  // A busy machine is no mistake of the page's: held against it when asked for only.
  if (process.env.REPORT_TIMES) assert.ok(Math.min(...times) < 1000, `${times} ms`);
});

test("names are text, never markup", async () => {
  assert.equal(await page.locator("h1").textContent(), results.sweep.title);
  assert.equal(await page.locator("figcaption").nth(2).textContent(), "meshes <1>");
});

chart_tests(results, report);
viewer_tests(results, report);
table_tests(results, report);
palette_tests(report);

test("the manifest names machine, program, references, formulas and the sweep file", async () => {
  await open_report(report);
  await page.evaluate(() => document.querySelectorAll("#manifest details").forEach((d) => (d.open = true)));
  const text = await page.locator("#manifest").innerText();
  for (const part of [
    "zonal 0.1.0, clang 16.0.6",
    "A processor of 2 cores, 2 threads",
    "4096",
    "11, 12",
    "12 min",
    "mean((x-r)^2 / (r^2 + (0.1 mean r)^2))",
    "0.998 to 1.013",
    '"seeds": [0, 1, 2, 3, 4]',
  ])
    assert.ok(text.includes(part), `"${part}" is not in:\n${text}`);
});

test("links lead to the tables beside the page", async () => {
  const links = await page.locator(".downloads a").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
  assert.deepEqual(links, ["results.csv", "table.md", "table.tex"]);
});

test("480 px are enough: nothing but the table scrolls sideways", async () => {
  await open_report(report, {width: 480});
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 480);
  for (const box of await page.locator(".panels svg").all()) assert.ok((await box.boundingBox()).width <= 480);
  await page.getByRole("button", {name: "Side by side"}).click();
  await settle();
  const {width, height} = await page.locator("#viewer canvas").boundingBox();
  assert.ok(height > width, "pictures stand one above the other");
  if (process.env.REPORT_SCREENSHOTS) await page.screenshot({path: join(work, "narrow.png"), fullPage: true});
});

test("dark mode is dark, print is light, and text has contrast in both", async () => {
  const look = () =>
    page.evaluate(() => {
      const luminance = (css) => {
        const [r, g, b] = css.match(/[\d.]+/g).map((v) => ((v / 255 + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const style = (selector) => getComputedStyle(document.querySelector(selector));
      const ground = luminance(style("body").backgroundColor);
      const contrast = (css) => (Math.max(luminance(css), ground) + 0.05) / (Math.min(luminance(css), ground) + 0.05);
      return {
        ground,
        text: contrast(style("body").color),
        note: contrast(style(".note").color),
        bad: contrast(style(".badge.bad").color),
        axis: contrast(style("#panels svg text").fill),
        controls: style("nav").display,
      };
    });
  for (const [scheme, dark] of [
    ["light", false],
    ["dark", true],
  ]) {
    await open_report(report, {scheme});
    const seen = await look();
    assert.equal(seen.ground < 0.1, dark);
    for (const part of ["text", "note", "bad", "axis"])
      assert.ok(seen[part] >= 4.5, `${scheme}: ${part} ${seen[part]}`);
    if (process.env.REPORT_SCREENSHOTS) await page.screenshot({path: join(work, `${scheme}.png`), fullPage: true});
  }
  await page.emulateMedia({media: "print", colorScheme: "dark"});
  const printed = await look();
  assert.ok(printed.ground > 0.9);
  assert.equal(printed.controls, "none");
});

test("nothing has gone wrong so far but the picture that is missing, and nothing was asked for beyond the folder", () => {
  assert.deepEqual(
    problems.filter((text) => !text.includes("ERR_FILE_NOT_FOUND")),
    [],
  );
  assert.deepEqual(
    requests.filter((url) => !url.startsWith(`file://${report}/`) && !url.startsWith("data:")),
    [],
  );
});

test("the page's own policy refuses outside addresses", async () => {
  await open_report(report);
  const refused = await page.evaluate(
    () =>
      new Promise((done) => {
        const blocked = [];
        document.addEventListener(
          "securitypolicyviolation",
          (event) => blocked.push(event.effectiveDirective) === 3 && done(blocked),
        );
        new Image().src = "http://127.0.0.1:9/x.png";
        document.head.append(Object.assign(document.createElement("script"), {src: "http://127.0.0.1:9/x.js"}));
        fetch("http://127.0.0.1:9/").catch(() => {});
        setTimeout(() => done(blocked), 2000);
      }),
  );
  assert.deepEqual(refused.sort(), ["connect-src", "img-src", "script-src-elem"]);
});

test("without the bundle the page shows the program's charts, and all the rest works", async () => {
  const plain = join(work, "plain");
  rmSync(plain, {recursive: true, force: true});
  mkdirSync(join(plain, "charts"), {recursive: true});
  for (const file of ["index.html", "data.js", "images"])
    cpSync(join(report, file), join(plain, file), {recursive: true});
  writeFileSync(
    join(plain, "charts", "scene-0.svg"),
    `<svg xmlns="http://www.w3.org/2000/svg" width="300" height="200"/>`,
  );
  problems.length = 0;
  await open_report(plain, {charts: false});
  await page.waitForFunction(() => document.querySelector("#panels img")?.naturalWidth === 300);
  assert.ok((await page.locator("#results tbody tr").count()) > 30);
  await page.waitForFunction(() => document.querySelector(".readout").textContent.includes("640 × 360"));
  await page.locator("#metric").selectOption({label: "SSIM"});
  assert.deepEqual(
    problems.filter((text) => !text.includes("ERR_FILE_NOT_FOUND")),
    [],
  );
});

/// Opens a report of these results, without pictures.
async function open_results(name, made) {
  const folder = join(work, name);
  mkdirSync(folder, {recursive: true});
  for (const file of ["index.html", "report.bundle.js"]) cpSync(join(report, file), join(folder, file));
  writeFileSync(join(folder, "data.js"), `zonal_results(${JSON.stringify(made)});`);
  problems.length = 0;
  await open_report(folder, {charts: false});
  await page.waitForSelector("#panels figure > :nth-child(2)");
}

test("results with little in them make a page all the same", async () => {
  const cells = [0, 1].map((seed) => ({
    id: `c${seed}`,
    scene: "s",
    method: "m",
    backend: "cpu",
    seed,
    group: 0,
    status: "done",
    scores: {rmse: null},
  }));
  const bare = {metrics: [{name: "rmse", values: "linear"}], scenes: [{id: "s", name: "s"}], methods: [{id: "m"}]};
  await open_results("none", {...bare, cells: [], groups: []});
  await open_results("bare", {
    ...bare,
    cells,
    groups: [
      {
        id: 0,
        scene: "s",
        method: "m",
        backend: "cpu",
        varied: {},
        cells: ["c0", "c1", "gone"],
        failed: 0,
        time: {mean: null, low: null, high: null},
        scores: {rmse: null},
        noise: null,
        bias: null,
      },
    ],
  });
  assert.equal(await page.locator("#results tbody tr").count(), 1);
  assert.match(await page.locator("#chart-note").textContent(), /1 group without a time or a score/);
  // Scores without intervals, of one seed; and a perfect picture.
  const one = {
    id: 0,
    scene: "s",
    method: "m",
    backend: "cpu",
    varied: null,
    cells: ["c0"],
    failed: 0,
    noise: null,
    bias: null,
    time: {mean: 2, low: null, high: null},
    scores: {psnr: {mean: 30, low: null, high: null, worst: 30, seeds: 1}},
  };
  await open_results("one", {
    ...bare,
    metrics: [{name: "psnr", values: "display", better: "higher", unit: "dB"}],
    cells,
    groups: [
      one,
      {...one, id: 1, cells: ["c1"], scores: {psnr: {mean: "inf", low: "inf", high: "inf", worst: "inf", seeds: 1}}},
    ],
  });
  assert.equal(await page.locator("#panels g.points > *").count(), 1);
  assert.ok((await page.locator("#results").innerText()).includes("∞"));
  assert.deepEqual(problems, []);
});

test("two backends of a method are told apart; many scenes open on the first one", async () => {
  const gl = (item) => ({
    ...item,
    backend: "gl",
    id: `gl ${item.id}`,
    group: `gl ${item.group}`,
    cells: item.cells?.map((id) => `gl ${id}`),
  });
  const twice = {
    ...results,
    cells: [...results.cells, ...results.cells.map(gl)],
    groups: [...results.groups, ...results.groups.map(gl)],
    scenes: [...results.scenes, {id: "more", name: "more"}, {id: "most", name: "most"}],
  };
  await open_results("twice", twice);
  assert.equal(await page.locator("#panels figure").count(), 1);
  const names = await page
    .locator("#panels g.points > *")
    .evaluateAll((all) => all.map((p) => p.getAttribute("aria-label")));
  assert.equal(new Set(names).size, names.length);
  assert.ok(names.includes("vpl, gl · lights 100"));
  assert.ok(await page.locator("#panels g.lines[stroke-dasharray] path").count());
  assert.deepEqual(
    problems.filter((text) => !text.includes("ERR_FILE_NOT_FOUND")),
    [],
  );
});

test("without data the page says so", async () => {
  const empty = join(work, "empty");
  mkdirSync(empty, {recursive: true});
  cpSync(join(report, "index.html"), join(empty, "index.html"));
  await open_report(empty, {charts: false});
  await page.waitForFunction(() => /data\.js.*missing/.test(document.querySelector("#problem").textContent));
  assert.ok(await page.locator("#problem").isVisible());
});
