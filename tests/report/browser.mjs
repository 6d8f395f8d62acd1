// One headless Chromium for all tests, and what they ask of the page in it.

import {mkdtempSync, rmSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";

export const work = process.env.REPORT_WORK;
const {chromium} = createRequire(join(work, "driver", "package.json"))("playwright-core");

const profile = mkdtempSync(join(tmpdir(), "report-test-"));
const context = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.REPORT_CHROMIUM,
  headless: true,
  viewport: {width: 1280, height: 900},
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
  ],
});
export const page = context.pages()[0] ?? (await context.newPage());
page.setDefaultTimeout(10000);

/// All addresses the page has asked for, and all errors it has raised or printed.
export const requests = [],
  problems = [];
context.on("request", (request) => requests.push(request.url()));
page.on("pageerror", (error) => problems.push(error.message));
page.on("console", (message) => message.type() === "error" && problems.push(message.text()));

export async function close() {
  await context.close();
  rmSync(profile, {recursive: true, force: true});
}

/// Opens a report afresh, in light mode, and waits until its charts are there.
export async function open_report(folder, {width = 1280, height = 900, scheme = "light", charts = true} = {}) {
  await page.setViewportSize({width, height});
  await page.emulateMedia({colorScheme: scheme, media: "screen"});
  await page.goto(`file://${folder}/index.html`);
  if (charts) await page.waitForSelector("#strips svg g.points");
}

/// Two frames: whatever was asked for has been drawn.
export const settle = () =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/// Waits until what the viewer was asked for has been loaded and drawn.
export async function viewer_ready() {
  await page.waitForFunction(() => !document.querySelector(".stage .label").textContent.includes("loading"));
  await page.waitForTimeout(200);
  await settle();
}

export const canvas = () => page.locator("#viewer canvas");
export const readout = () => page.locator("#viewer .readout").textContent();
export const label = (i) => page.locator("#viewer .label").nth(i).textContent();

/// [r, g, b] of the canvas at a place in CSS px.
export const color_at = (x, y) =>
  canvas().evaluate(
    (element, [cx, cy]) => {
      const scale = element.width / element.clientWidth;
      return [
        ...element
          .getContext("2d")
          .getImageData(Math.floor(cx * scale), Math.floor(cy * scale), 1, 1)
          .data.slice(0, 3),
      ];
    },
    [x, y],
  );

/// Moves the pointer to a place of the canvas, in CSS px from its corner.
export async function point_at(x, y) {
  const box = await canvas().boundingBox();
  await page.mouse.move(box.x + x, box.y + y);
  await settle();
}

/// Brings the viewer into view and gives its canvas the keys.
export async function focus_viewer() {
  await page.locator("#images").scrollIntoViewIfNeeded();
  await page.evaluate(() => document.querySelector("#images").scrollIntoView({behavior: "instant"}));
  await canvas().focus();
  await viewer_ready();
}
