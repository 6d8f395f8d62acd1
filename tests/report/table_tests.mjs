// The table: order, words, and rows for what did not work.

import {test} from "node:test";
import assert from "node:assert/strict";

import {open_report, page, viewer_ready} from "./browser.mjs";

const rows = () => page.locator("#results tbody tr");
const heading = (key) => page.locator(`#results th[data-key="${key}"]`);
const filter = (words) => page.locator("#filter").fill(words);

/// The texts of a column from top to bottom.
const column = (key) =>
  page.locator("#results table").evaluate((table, name) => {
    const at = [...table.querySelectorAll("th")].findIndex((th) => th.dataset.key === name);
    return [...table.querySelectorAll("tbody tr")].map((row) => row.cells[at].innerText);
  }, key);

const numbers = (texts) => texts.filter((t) => t !== "–").map((t) => Number(t.replaceAll("−", "-")));
const rising = (values) => values.every((v, i) => i === 0 || values[i - 1] <= v);

export function table_tests(results, report) {
  test("headings sort both ways, by mouse and by key, and say so; unknown values come last", async () => {
    await open_report(report);
    assert.equal(await heading("scene").getAttribute("aria-sort"), "ascending");
    await heading("time").getByRole("button").click();
    assert.equal(await heading("time").getAttribute("aria-sort"), "ascending");
    assert.equal(await heading("scene").getAttribute("aria-sort"), null);
    let texts = await column("time");
    assert.ok(rising(numbers(texts)));
    assert.equal(texts.at(-1), "–");
    await heading("time").getByRole("button").focus();
    await page.keyboard.press("Enter");
    assert.equal(await heading("time").getAttribute("aria-sort"), "descending");
    texts = await column("time");
    assert.ok(rising(numbers(texts).reverse()) && numbers(texts).length > 30);
    assert.equal(texts.at(-1), "–");
    // Of a score of which more is better, the best comes first.
    await heading("psnr").getByRole("button").click();
    assert.ok(rising(numbers(await column("psnr")).reverse()));
    // Equal ones stay in the order of the heading before.
    await heading("worst").getByRole("button").click();
    await heading("method").getByRole("button").click();
    const methods = await column("method"),
      worst = await column("worst");
    assert.ok(rising(numbers(worst.filter((_, i) => methods[i].includes("vpl")))));
  });

  test("headings carry units; the worst seed, noise and bias have columns", async () => {
    for (const [key, unit] of [
      ["time", "s"],
      ["rmse", "W m⁻² sr⁻¹"],
      ["worst", "W m⁻² sr⁻¹"],
      ["noise", "W m⁻² sr⁻¹"],
      ["bias_part", "W m⁻² sr⁻¹"],
      ["psnr", "dB"],
    ])
      assert.ok((await heading(key).innerText()).endsWith(unit), `${key}: ${await heading(key).innerText()}`);
    const group = results.groups[0];
    await filter("atrium vpl 100");
    assert.equal(await rows().count(), 1);
    const shown = async (key) => Number((await column(key))[0]);
    assert.equal(await shown("rmse"), Number(group.scores.rmse.mean.toPrecision(3)));
    assert.equal(await shown("worst"), Number(group.scores.rmse.worst.toPrecision(3)));
    assert.equal(await shown("noise"), Number(group.noise.toPrecision(3)));
  });

  test("the filter takes words in any order and counts what is left", async () => {
    await filter("400 HVL");
    assert.equal(await rows().count(), 3);
    assert.match(await page.locator("#results .count").textContent(), /^3 of \d+ rows$/);
    await filter("nothing has this");
    assert.equal(await rows().count(), 0);
    await filter("");
  });

  test("failed cells are rows with their reason; a missed budget is marked with what was reached", async () => {
    await filter("failed:");
    const failed = results.cells.filter((c) => c.status === "failed");
    assert.equal(await rows().count(), failed.length);
    const statuses = await column("status");
    for (const cell of failed) assert.ok(statuses.includes(`seed ${cell.seed} failed: ${cell.reason}`), cell.reason);
    await filter("not reached");
    assert.equal(await rows().count(), 1);
    assert.match((await column("status"))[0], /^not reached: [\d.]+ s of 0\.5 s$/);
    await filter("1 of 5 failed");
    assert.equal(await rows().count(), 1);
    await filter("");
  });

  test("every cell can be listed; a row's button shows its picture", async () => {
    await page.getByRole("button", {name: "Every cell"}).click();
    assert.equal(await rows().count(), results.cells.length);
    assert.ok((await column("repeat")).includes("--set lights=400 --seed 3"));
    await filter("cornell vsl 1600");
    await page.getByRole("button", {name: /^Show the picture of vsl/}).click();
    await viewer_ready();
    assert.equal(await page.locator("#viewer .label").first().textContent(), "A: vsl, 16 samples · lights 1600");
    await filter("");
  });

  test("another metric changes what the table is about; one scene alone leaves out the others", async () => {
    await page.getByRole("button", {name: "Means over seeds"}).click();
    await page.locator("#metric").selectOption({label: "SSIM"});
    assert.match(await heading("interval").innerText(), /^SSIM, 95\s%/);
    const all = await rows().count();
    await page.getByRole("group", {name: "Scene"}).getByRole("button", {name: "cornell"}).click();
    const left = await rows().count();
    assert.ok(left > 10 && left < all);
    assert.ok((await column("scene")).every((name) => name === "cornell"));
  });
}
