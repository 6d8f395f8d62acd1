// The methods' colours can be told apart, also by colour-blind eyes, in both modes.

import {test} from "node:test";
import assert from "node:assert/strict";

import {open_report, page} from "./browser.mjs";

// Machado, Oliveira and Fernandes 2009, severity 1, on linear RGB.
const kEyes = {
  all: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  tritanopia: [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
};

const linear = (hex) =>
  [1, 3, 5]
    .map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
    .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
const seen_by = (matrix, rgb) =>
  matrix.map((row) => Math.max(0, row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]));

/// Oklab (Ottosson 2020): distances that match what eyes call different.
function oklab([r, g, b]) {
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

export function palette_tests(report) {
  for (const scheme of ["light", "dark"]) {
    test(`colours in ${scheme} mode differ for all eyes and stand out from the page`, async () => {
      await open_report(report, {scheme});
      const colors = await page.evaluate(() => {
        const style = getComputedStyle(document.documentElement);
        return ["--page", ...[...Array(8).keys()].map((i) => `--m${i}`)].map((name) =>
          style.getPropertyValue(name).trim(),
        );
      });
      const [ground, ...methods] = colors.map(linear);
      for (const [i, color] of methods.entries()) {
        const [a, b] = [luminance(color), luminance(ground)].sort((p, q) => q - p);
        assert.ok((a + 0.05) / (b + 0.05) >= 3 - 0.05, `m${i} against the page: ${(a + 0.05) / (b + 0.05)}`);
      }
      for (const [eyes, matrix] of Object.entries(kEyes)) {
        const labs = methods.map((color) => oklab(seen_by(matrix, color)));
        for (let i = 0; i < 8; ++i) {
          for (let j = i + 1; j < 8; ++j) {
            const distance = Math.hypot(...labs[i].map((v, c) => v - labs[j][c]));
            assert.ok(distance >= (j < 4 ? 0.1 : 0.05), `m${i} and m${j} for ${eyes}: ${distance}`);
          }
        }
      }
    });
  }
}
