// The charts: every group stands where its numbers say, the front is the front, and points answer.

import {test} from "node:test";
import assert from "node:assert/strict";

import {open_report, page, settle, viewer_ready} from "./browser.mjs";

const kPanel = '#panels figure[data-scene="scene-0"]';

/// Reads the chart's scales off its tick labels, knowing nothing of the code that drew them: least squares through
/// (position, log10 of label) or (position, label).
async function read_axes({log_y = true} = {}) {
  const ticks = await page.locator(kPanel).evaluate((figure) =>
    ["x", "y"].map((dimension) =>
      [...figure.querySelectorAll(`[aria-label="${dimension}-axis tick label"] text`)].map((text) => {
        const [, x, y] = /translate\(([-\d.]+),([-\d.]+)\)/.exec(text.getAttribute("transform"));
        return {at: Number(dimension === "x" ? x : y), value: Number(text.textContent.replace("−", "-"))};
      }),
    ),
  );
  return [fit(ticks[0], true), fit(ticks[1], log_y)];
}

function fit(ticks, log) {
  assert.ok(ticks.length >= 2, "an axis has two ticks at least");
  const points = ticks.filter((t) => !log || t.value > 0).map((t) => [log ? Math.log10(t.value) : t.value, t.at]);
  const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
  const [mx, my] = [mean(points.map((p) => p[0])), mean(points.map((p) => p[1]))];
  const slope = mean(points.map((p) => (p[0] - mx) * (p[1] - my))) / mean(points.map((p) => (p[0] - mx) ** 2));
  return (value) => my + slope * ((log ? Math.log10(value) : value) - mx);
}

const markers = () =>
  page.locator(`${kPanel} g.points > *`).evaluateAll((all) =>
    all.map((element) => {
      const [, x, y] = /translate\(([-\d.]+),([-\d.]+)\)/.exec(element.getAttribute("transform"));
      return {
        x: Number(x),
        y: Number(y),
        name: element.getAttribute("aria-label"),
        fill: element.getAttribute("fill"),
      };
    }),
  );

/// The groups of the first scene as their names are shown.
function groups_of(results) {
  const method = new Map(results.methods.map((m) => [m.id, m.label]));
  return results.groups
    .filter((g) => g.scene === "scene-0" && g.time)
    .map((group) => {
      const [name, value] = Object.entries(group.varied)[0];
      return {...group, name: `${method.get(group.method)} · ${name} ${value}`};
    });
}

/// Groups that no other beats in time and error at once, by comparing all pairs.
const front_of = (groups, error) =>
  groups.filter(
    (g) => !groups.some((other) => other !== g && other.time.mean <= g.time.mean && error(other) <= error(g)),
  );

/// The corners of the drawn front.
const drawn_front = () =>
  page
    .locator(`${kPanel} g.front path`)
    .getAttribute("d")
    .then((d) => [...d.matchAll(/([-\d.]+),([-\d.]+)/g)].map((m) => [Number(m[1]), Number(m[2])]));

async function expect_front(groups, error, x, y) {
  const corners = await drawn_front(),
    front = front_of(groups, error);
  for (const g of groups) {
    const on_it = corners.some(([cx, cy]) => Math.hypot(cx - x(g.time.mean), cy - y(error(g))) < 1.5);
    assert.equal(on_it, front.includes(g), g.name);
  }
}

async function expect_places(groups, x, y, value) {
  const drawn = await markers();
  assert.equal(drawn.length, groups.length);
  for (const g of groups) {
    const marker = drawn.find((m) => m.name === g.name);
    assert.ok(marker, `${g.name} is drawn`);
    // Tick labels are read to 0.1 px or so; a wrong scale is off by tens.
    assert.ok(Math.abs(marker.x - x(g.time.mean)) < 1.5 && Math.abs(marker.y - y(value(g))) < 1.5, g.name);
  }
}

export function chart_tests(results, report) {
  const groups = groups_of(results);
  const metric = (label) => page.locator("#metric").selectOption({label});

  test("every group stands at its time and error; reference-limited ones are hollow", async () => {
    await open_report(report);
    const [x, y] = await read_axes();
    await expect_places(groups, x, y, (g) => g.scores.rmse.mean);
    const hollow = (await markers()).filter((m) => m.fill.includes("surface")).map((m) => m.name);
    assert.deepEqual(
      hollow,
      groups.filter((g) => g.reference_limited).map((g) => g.name),
    );
    assert.equal(await page.locator("#panels figure").count(), results.scenes.length);
  });

  test("the front is what no group beats in both; the reference's floor is drawn at its value", async () => {
    const [x, y] = await read_axes();
    await expect_front(groups, (g) => g.scores.rmse.mean, x, y);
    const floor = await page.locator(`${kPanel} g.floor line`).first().getAttribute("y1");
    assert.ok(Math.abs(Number(floor) - y(0.025)) < 1.5);
  });

  test("intervals smaller than their marker show beyond it", async () => {
    const hvl = groups.find((g) => g.method === "hvl-5"),
      [x, y] = await read_axes();
    const bars = await page
      .locator(`${kPanel} g.interval`)
      .evaluateAll((layers) =>
        layers.flatMap((layer) =>
          [...layer.querySelectorAll("path")]
            .filter((p) => !p.closest("marker"))
            .map((path) => ({
              d: path.getAttribute("d"),
              cap: Number(layer.querySelector("marker")?.getAttribute("markerWidth")),
              stroke: path.getAttribute("stroke") ?? layer.getAttribute("stroke"),
            })),
        ),
      );
    const mine = bars.filter(({d}) => {
      const [[x1, y1], [x2, y2]] = [...d.matchAll(/([-\d.]+),([-\d.]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);
      return (
        Math.abs(x1 - x(hvl.time.mean)) < 1
        && Math.abs(x2 - x1) < 0.01
        && Math.abs(y1 - y(hvl.scores.rmse.low)) < 1.5
        && Math.abs(y2 - y(hvl.scores.rmse.high)) < 1.5
      );
    });
    assert.ok(Math.abs(y(hvl.scores.rmse.low) - y(hvl.scores.rmse.high)) < 4, "the fixture has such an interval");
    assert.ok(
      mine.some((bar) => bar.stroke.startsWith("var(--m") && bar.cap >= 20),
      JSON.stringify(mine),
    );
  });

  test("SSIM is drawn as 1 − SSIM on a log axis, PSNR upside down: lower left stays better", async () => {
    await metric("SSIM");
    await settle();
    assert.ok(await page.locator(kPanel).getByText("1 − SSIM").count());
    let [x, y] = await read_axes();
    await expect_places(groups, x, y, (g) => 1 - g.scores.ssim.mean);
    await metric("PSNR");
    await settle();
    [x, y] = await read_axes({log_y: false});
    await expect_places(groups, x, y, (g) => g.scores.psnr.mean);
    await expect_front(
      groups,
      (g) => -g.scores.psnr.mean,
      x,
      (negated) => y(-negated),
    );
    assert.ok(y(20) < y(30));
  });

  test("a metric with zeros keeps them, on a row of their own", async () => {
    await metric("fireflies");
    await settle();
    const zeros = groups.filter((g) => g.scores.fireflies.mean === 0),
      drawn = await markers();
    const row = await page
      .locator(kPanel)
      .evaluate(
        (figure) =>
          [...figure.querySelectorAll('[aria-label="y-axis tick label"] text')]
            .filter((t) => t.textContent === "0")
            .map((t) => Number(/,([-\d.]+)\)/.exec(t.getAttribute("transform"))[1]))[0],
      );
    assert.ok(zeros.length > 3);
    for (const g of zeros) assert.ok(Math.abs(drawn.find((m) => m.name === g.name).y - row) < 1, g.name);
    await metric("RMSE");
  });

  test("the legend hides a method everywhere, and the front is drawn anew", async () => {
    await page.locator("#legend button", {hasText: "hvl"}).click();
    await settle();
    const rest = groups.filter((g) => g.method !== "hvl-5"),
      [x, y] = await read_axes();
    await expect_places(rest, x, y, (g) => g.scores.rmse.mean);
    await expect_front(rest, (g) => g.scores.rmse.mean, x, y);
    assert.equal(await page.locator("#strips").getByText("hvl, 5 bands").count(), 0);
    await page.locator("#legend button", {hasText: "hvl"}).click();
    await page.locator("#legend button", {hasText: "path"}).click({modifiers: ["Shift"]});
    await settle();
    assert.equal((await markers()).length, 3);
    await page.locator("#legend button", {hasText: "path"}).click({modifiers: ["Shift"]});
    await settle();
    assert.equal((await markers()).length, groups.length);
  });

  test("a point shows its numbers when hovered or focused, and its picture when clicked or entered", async () => {
    const group = groups.find((g) => g.method === "vpl" && g.varied.lights === 400);
    const point = page.locator(`${kPanel} g.points > [aria-label="${group.name}"]`);
    await point.hover({force: true});
    const tip = await page.locator("#tooltip").innerText();
    for (const value of [group.time.mean, group.scores.rmse.mean, group.scores.rmse.worst])
      assert.ok(tip.includes(value.toPrecision(3)), `${value} in ${tip}`);
    await point.click({force: true});
    await viewer_ready();
    assert.equal(await page.locator("#viewer .label").first().textContent(), `A: ${group.name}`);

    const other = groups.find((g) => g.method === "path" && g.varied.passes === 16);
    await page.locator(`${kPanel} g.points > [aria-label="${other.name}"]`).focus();
    assert.ok((await page.locator("#tooltip").innerText()).includes(other.name));
    await page.keyboard.press("Enter");
    await viewer_ready();
    assert.equal(await page.locator("#viewer .label").first().textContent(), `A: ${other.name}`);
  });

  test("error over time: a curve with a marker at each scored pass, single points for the rest", async () => {
    await page.getByRole("button", {name: "Error over time"}).click();
    await settle();
    const [x, y] = await read_axes(),
      drawn = await markers();
    const path = groups.filter((g) => g.method === "path"),
      points = path.reduce((n, g) => n + 1 + Math.log2(g.varied.passes), 0);
    assert.equal(drawn.length, points + groups.length - path.length);
    const cells = results.cells.filter((c) => c.group === path[2].id);
    const mean = (value) => cells.reduce((sum, c) => sum + value(c.curve[3]), 0) / cells.length;
    const [px, py] = [x(mean((p) => p.seconds)), y(mean((p) => p.scores.rmse))];
    assert.ok(drawn.some((m) => m.name === path[2].name && Math.hypot(m.x - px, m.y - py) < 2));
    await page.getByRole("button", {name: "Final error"}).click();
  });

  test("one scene alone is drawn large", async () => {
    await page.getByRole("group", {name: "Scene"}).getByRole("button", {name: "atrium"}).click();
    await settle();
    assert.equal(await page.locator("#panels figure").count(), 1);
    assert.ok((await page.locator("#panels svg").boundingBox()).width > 1000);
  });

  test("stability: a marker for each seed, the worst one ringed", async () => {
    const strips = page.locator('#strips figure[data-scene="scene-0"]');
    const seeds = results.cells.filter((c) => c.scene === "scene-0" && c.status !== "failed").length;
    assert.equal(await strips.locator("g.points > *").count(), seeds);
    assert.equal(await strips.locator("g.worst > *").count(), groups.length);
    const group = groups[0],
      worst = results.cells.filter((c) => c.group === group.id).sort((a, b) => b.scores.rmse - a.scores.rmse)[0];
    await strips.locator(`g.points > [aria-label="${group.name}, seed ${worst.seed}"]`).focus();
    assert.ok((await page.locator("#tooltip").innerText()).includes(worst.scores.rmse.toPrecision(3)));
  });
}
