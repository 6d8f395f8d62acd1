// The image viewer: what it paints and reads out is compared with the pictures the fixture was drawn from.

import {test} from "node:test";
import assert from "node:assert/strict";

import {
  canvas,
  color_at,
  focus_viewer,
  label,
  open_report,
  page,
  point_at,
  readout,
  settle,
  viewer_ready,
} from "./browser.mjs";
import {draw_scene, with_noise} from "./fixture_images.mjs";
import {missing_image, random} from "./make_fixture.mjs";

const kWidth = 640,
  kHeight = 360,
  kExposure = 0.8;

/// sRGB bytes of a radiance at an exposure, by the standard's formula.
const display = (rgb, stops = 0) =>
  rgb
    .map((v) => Math.min(1, v * kExposure * 2 ** stops))
    .map((v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));

const pixel = (image, x, y) => [0, 1, 2].map((c) => image.rgb[3 * (y * kWidth + x) + c]);

/// RGB9E5 rounds a channel by up to 1/512 of the largest one; sRGB of values near black stretches that, at most 13-fold.
function expect_color(seen, rgb, stops, what) {
  const slack = Math.max(...rgb) / 512;
  const low = display(
      rgb.map((v) => Math.max(0, v - slack)),
      stops,
    ),
    high = display(
      rgb.map((v) => v + slack),
      stops,
    );
  seen.forEach((byte, c) =>
    assert.ok(byte >= low[c] - 1.5 && byte <= high[c] + 1.5, `${what}: ${seen} for ${display(rgb, stops)}`),
  );
}

/// Where a pixel of the picture lies while the whole of it is shown, in CSS px.
async function fitted(x, y, pane = {left: 0, share: 1}) {
  const {width, height} = await canvas().boundingBox(),
    pane_width = width * pane.share;
  const zoom = Math.min(pane_width / kWidth, height / kHeight);
  return [
    width * pane.left + pane_width / 2 + (x + 0.5 - kWidth / 2) * zoom,
    height / 2 + (y + 0.5 - kHeight / 2) * zoom,
  ];
}

const mode = (name) => page.getByRole("group", {name: "Mode"}).getByRole("button", {name}).click();
const press = async (key) => {
  await canvas().press(key);
  await viewer_ready();
};

/// {x, y, A: [r, g, b], B} of the line below the picture.
function parse(text) {
  const at = /x (\d+), y (\d+)/.exec(text);
  const values = (side) =>
    new RegExp(`${side} ([-\\d.e−∞]+) ([-\\d.e−∞]+) ([-\\d.e−∞]+)`)
      .exec(text)
      ?.slice(1)
      .map((v) => Number(v.replaceAll("−", "-")));
  return {
    x: Number(at?.[1]),
    y: Number(at?.[2]),
    A: values("A"),
    B: values("B"),
    error: Number(/error ([\d.]+)/.exec(text)?.[1]),
  };
}

const close_to = (seen, expected, what) =>
  seen.forEach((v, c) => {
    // Three digits are printed.
    const slack = Math.max(...expected) / 512 + 0.005 * Math.abs(expected[c]);
    assert.ok(Math.abs(v - expected[c]) <= slack, `${what}: ${seen} for ${expected}`);
  });

export function viewer_tests(results, report) {
  const truth = draw_scene(0, kWidth, kHeight);
  const group = (method, count) =>
    results.groups.find((g) => g.scene === "scene-0" && g.method === method && Object.values(g.varied)[0] === count);
  const picture = (g) =>
    with_noise(truth, results.cells.find((c) => c.id === g.cells[0]).scores.rmse, random(g.id + 1));
  const vpl = picture(group("vpl", 100));
  const kPoints = [
    [40, 30],
    [320, 150],
    [500, 330],
    [300, 130],
  ];

  test("the viewer shows radiance times exposure, sRGB-encoded; numbers choose methods and 0 the reference", async () => {
    await open_report(report);
    await focus_viewer();
    await mode("Single");
    await page.locator(".picker select").first().selectOption({label: "vpl · lights 100"});
    await viewer_ready();
    assert.equal(await label(0), "vpl · lights 100");
    for (const [x, y] of kPoints)
      expect_color(await color_at(...(await fitted(x, y))), pixel(vpl, x, y), 0, `vpl at ${x}, ${y}`);
    await press("0");
    assert.equal(await label(0), "reference");
    for (const [x, y] of kPoints)
      expect_color(await color_at(...(await fitted(x, y))), pixel(truth, x, y), 0, `reference at ${x}, ${y}`);
    await press("3");
    assert.match(await label(0), /^hvl, 5 bands/);
    await press("1");
    const first = await label(0);
    await press("1");
    assert.match(first, /^vpl · lights/);
    assert.match(await label(0), /^vpl · lights/);
    assert.notEqual(await label(0), first, "pressed again: the next parameters");
  });

  test("+ and − change the exposure by half a stop; the slider does too", async () => {
    await press("0");
    await press("+");
    await press("+");
    await press("+");
    for (const [x, y] of kPoints)
      expect_color(await color_at(...(await fitted(x, y))), pixel(truth, x, y), 1.5, `${x}, ${y}`);
    assert.equal(await page.locator(".exposure output").textContent(), "+1.50 stops");
    await page.locator(".exposure input").fill("-2");
    await viewer_ready();
    for (const [x, y] of kPoints)
      expect_color(await color_at(...(await fitted(x, y))), pixel(truth, x, y), -2, `${x}, ${y}`);
    await page.locator(".exposure input").fill("0");
  });

  test("F and space flip between A and B", async () => {
    await page.locator(".picker select").first().selectOption({label: "vpl · lights 100"});
    await canvas().focus();
    await press("f");
    assert.equal(await label(0), "B: reference");
    expect_color(await color_at(...(await fitted(40, 30))), pixel(truth, 40, 30), 0, "B");
    await press(" ");
    assert.equal(await label(0), "A: vpl · lights 100");
    expect_color(await color_at(...(await fitted(40, 30))), pixel(vpl, 40, 30), 0, "A");
    await press("x");
    assert.equal(await label(0), "A: reference");
    await press("x");
  });

  test("the pointer reads linear radiance of both sides", async () => {
    for (const [x, y] of kPoints) {
      await point_at(...(await fitted(x, y)));
      const seen = parse(await readout());
      assert.deepEqual([seen.x, seen.y], [x, y]);
      close_to(seen.A, pixel(vpl, x, y), "A");
      close_to(seen.B, pixel(truth, x, y), "B");
    }
  });

  test("the wheel zooms about the pointer to square pixels; arrows and drags move, R shows the whole", async () => {
    await mode("Single");
    const [cx, cy] = await fitted(300, 130);
    await point_at(cx, cy);
    await page.waitForTimeout(300);
    for (let i = 0; i < 9; ++i) await page.mouse.wheel(0, -100);
    await settle();
    const seen = parse(await readout());
    assert.deepEqual([seen.x, seen.y], [300, 130], "what is under the pointer stays");
    // A notch is half a doubling: nine of them are 2^4.5.
    const {width, height} = await canvas().boundingBox(),
      zoom = Math.min(width / kWidth, height / kHeight) * 2 ** 4.5;
    const rows = [];
    for (const dx of [-0.45, -0.2, 0, 0.2, 0.45]) rows.push(await color_at(cx + dx * zoom, cy));
    assert.ok(
      rows.every((color) => String(color) === String(rows[0])),
      "one pixel is one colour",
    );
    expect_color(rows[0], pixel(vpl, 300, 130), 0, "its own");
    expect_color(await color_at(cx + zoom, cy), pixel(vpl, 301, 130), 0, "its neighbour's");

    await page.mouse.down();
    await page.mouse.move((await canvas().boundingBox()).x + cx - 3 * zoom, (await canvas().boundingBox()).y + cy, {
      steps: 4,
    });
    await page.mouse.up();
    await settle();
    expect_color(await color_at(cx, cy), pixel(vpl, 303, 130), 0, "dragged by three pixels");
    await press("ArrowRight"); // moves the view by 48 CSS px
    expect_color(await color_at(cx - 48, cy), pixel(vpl, 303, 130), 0, "moved by an arrow");
    await press("r");
    expect_color(await color_at(...(await fitted(40, 30))), pixel(vpl, 40, 30), 0, "whole again");
  });

  test("far in, pixels carry their numbers", async () => {
    const [cx, cy] = await fitted(40, 30);
    await point_at(cx, cy);
    for (let i = 0; i < 13; ++i) await page.mouse.wheel(0, -100);
    await settle();
    const colors = await canvas().evaluate((element) => {
      const {data} = element
        .getContext("2d")
        .getImageData(element.width / 2 - 100, element.height / 2 - 100, 200, 200);
      let black = 0;
      for (let i = 0; i < data.length; i += 4) black += data[i] + data[i + 1] + data[i + 2] < 60;
      return black;
    });
    assert.ok(colors > 100, `${colors} pixels of writing`);
    await page.mouse.dblclick((await canvas().boundingBox()).x + cx, (await canvas().boundingBox()).y + cy);
    await settle();
    expect_color(
      await color_at(...(await fitted(500, 330))),
      pixel(vpl, 500, 330),
      0,
      "a double click shows the whole",
    );
  });

  test("the bar of the split is dragged: A left of it, B right", async () => {
    await mode("Split");
    await settle();
    const {x, y, width, height} = await canvas().boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width * 0.25, y + height / 2, {steps: 5});
    await page.mouse.up();
    await settle();
    expect_color(await color_at(...(await fitted(40, 30))), pixel(vpl, 40, 30), 0, "left");
    expect_color(
      await color_at(...(await fitted(300, 130))),
      pixel(truth, 300, 130),
      0,
      "right of the bar, where A was",
    );
    await press("Shift+ArrowRight");
    const bar = await color_at(width * 0.27, height * 0.2);
    assert.deepEqual(bar, [255, 255, 255], "Shift and arrow move the bar by a fiftieth");
  });

  test("side by side both views move together", async () => {
    await mode("Side by side");
    await settle();
    const {width} = await canvas().boundingBox(),
      share = (width - 4) / 2 / width;
    const left = {left: 0, share},
      right = {left: 1 - share, share};
    const [ax, ay] = await fitted(200, 120, left),
      [bx, by] = await fitted(200, 120, right);
    await point_at(ax, ay);
    for (let i = 0; i < 8; ++i) await page.mouse.wheel(0, -100);
    await settle();
    expect_color(await color_at(ax, ay), pixel(vpl, 200, 120), 0, "A, zoomed");
    expect_color(await color_at(bx, by), pixel(truth, 200, 120), 0, "B, zoomed along");
    await point_at(bx, by);
    assert.deepEqual([parse(await readout()).x, parse(await readout()).y], [200, 120]);
    await press("r");
  });

  test("the error map is the relative error, on a scale that says its end", async () => {
    await mode("Single");
    await press("e");
    const mean = truth.rgb.reduce((a, b) => a + b, 0) / truth.rgb.length;
    const relative = (x, y) =>
      Math.sqrt(
        pixel(vpl, x, y).reduce((sum, v, c) => {
          const r = pixel(truth, x, y)[c];
          return sum + (v - r) ** 2 / (r * r + (0.1 * mean) ** 2);
        }, 0) / 3,
      );
    const all = [];
    for (let y = 0; y < kHeight; ++y) for (let x = 0; x < kWidth; ++x) all.push(relative(x, y));
    all.sort((a, b) => a - b);
    const high = [0.1, 0.2, 0.5, 1, 2, 5].find((end) => all[Math.floor(((all.length - 1) * 99) / 100)] <= end);
    assert.equal(await page.locator(".scale span").first().textContent(), `≥ ${high}`);
    for (const [x, y] of kPoints) {
      await point_at(...(await fitted(x, y)));
      // Two rounded pictures: each off by up to 1/512 of its brightest channel, which counts most in the dark.
      const slack =
        (2 * Math.max(...pixel(vpl, x, y), ...pixel(truth, x, y)))
        / 512
        / Math.hypot(Math.min(...pixel(truth, x, y)), 0.1 * mean);
      const seen = parse(await readout()).error;
      assert.ok(Math.abs(seen - relative(x, y)) < slack + 0.005 * seen, `${seen} for ${relative(x, y)}`);
      // Inferno's lightness rises with the error: more red for more error, from black.
      const [red] = await color_at(...(await fitted(x, y)));
      const share = relative(x, y) / high;
      assert.ok(share < 0.1 ? red < 80 : share < 0.8 ? red > 20 : red > 200, `red ${red} for a share of ${share}`);
    }
    await press("0");
    assert.deepEqual(await color_at(...(await fitted(40, 30))), [0, 0, 4], "the reference has none");
    await press("e");
    await press("1");
  });

  test("a picture that is missing is named, and the next one shows all the same", async () => {
    await page.getByRole("combobox", {name: "Scene of the pictures"}).selectOption({label: "cornell"});
    await page.locator(".picker select").first().selectOption({label: "path · passes 4"});
    await page.waitForFunction(() => /is missing/.test(document.querySelector(".readout").textContent));
    assert.ok((await readout()).includes(missing_image));
    await page.locator(".picker select").first().selectOption({label: "path · passes 16"});
    await page.waitForFunction(() => !/is missing/.test(document.querySelector(".readout").textContent));
    const cornell = draw_scene(1, kWidth, kHeight),
      g = results.groups.find((o) => o.scene === "scene-1" && o.varied.passes === 16);
    const shown = with_noise(cornell, results.cells.find((c) => c.id === g.cells[0]).scores.rmse, random(g.id + 1));
    expect_color(await color_at(...(await fitted(40, 30))), pixel(shown, 40, 30), 0, "the next one");
  });

  test("pictures not looked at for longest are let go and come back when asked for", async () => {
    const held = await page.evaluate(async () => {
      const files = ["100", "400", "1600"].flatMap((n) => ["vpl", "vsl"].map((m) => `images/at0-${m}-${n}-0.js`));
      Images.limit.bytes = 4e6; // four of 640 x 360
      for (const file of files) await Images.load(file);
      const kept = files.map((file) => Images.ready(file) !== null);
      const again = await Images.load(files[0]);
      return {kept, again: again.width};
    });
    assert.deepEqual(held, {kept: [false, false, true, true, true, true], again: 640});
  });
}
