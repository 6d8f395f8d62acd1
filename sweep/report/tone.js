"use strict";
// What radiance looks like: a picture at an exposure, or a map of its relative error with the colours and the scale of
// `zonal compare --error-map`.

const Tone = (() => {
  // Ten stops of matplotlib's "inferno" (van der Walt and Smith 2015): lightness rises evenly, also for colour-blind eyes.
  const kInferno = [
    "#000004",
    "#1b0c42",
    "#4b0c6b",
    "#781c6d",
    "#a52c60",
    "#cf4446",
    "#ed6925",
    "#fb9a06",
    "#f7d03c",
    "#fcffa4",
  ];
  const kNan = [0, 255, 0]; // a colour neither scale has

  // sRGB encoding (IEC 61966-2-1) of [0, 1] to bytes, by table: fine enough that the steep dark end misses no byte.
  const kSteps = 16384;
  const srgb = Uint8ClampedArray.from({length: kSteps + 1}, (_, i) => {
    const v = i / kSteps;
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  });

  function paint(image, color_of) {
    const canvas = h("canvas", {width: image.width, height: image.height});
    const context = canvas.getContext("2d"),
      pixels = context.createImageData(image.width, image.height);
    const bytes = pixels.data,
      rgb = [0, 0, 0];
    for (let i = 0, n = image.packed.length; i < n; ++i) {
      color_of(i, rgb);
      bytes[4 * i] = rgb[0];
      bytes[4 * i + 1] = rgb[1];
      bytes[4 * i + 2] = rgb[2];
      bytes[4 * i + 3] = 255;
    }
    for (const i of image.nan) bytes.set(kNan, 4 * i);
    context.putImageData(pixels, 0, 0);
    return canvas;
  }

  /// `exposure`: the factor on radiance before it is clamped to [0, 1].
  function picture(image, exposure) {
    const factor = exposure * kSteps;
    return paint(image, (i, rgb) => {
      Images.unpack(image.packed, i, rgb);
      for (let c = 0; c < 3; ++c) rgb[c] = srgb[Math.min(kSteps, Math.round(rgb[c] * factor))];
    });
  }

  /// A pixel's relative error, sqrt of the mean over channels of (x-r)^2 / (r^2 + (0.1 mean r)^2); NaN where either is.
  /// Comes with `high`, the first of 1, 2, 5 x 10^n that 99 % of the pixels stay below.
  function relative_error(image, reference) {
    const floor = (0.1 * mean_of(reference)) ** 2,
      n = image.packed.length;
    const error = new Float32Array(n),
      x = [0, 0, 0],
      r = [0, 0, 0];
    for (let i = 0; i < n; ++i) {
      Images.unpack(image.packed, i, x);
      Images.unpack(reference.packed, i, r);
      let sum = 0;
      for (let c = 0; c < 3; ++c) {
        const square = r[c] * r[c] + floor;
        // Black against an altogether black reference: no error.
        if (square > 0) sum += (x[c] - r[c]) ** 2 / square;
        else if (x[c] > 0) sum = Infinity;
      }
      error[i] = Math.sqrt(sum / 3);
    }
    for (const i of [...image.nan, ...reference.nan]) error[i] = NaN;
    return {error, high: scale_of(error)};
  }

  function mean_of(image) {
    const rgb = [0, 0, 0];
    let sum = 0;
    for (let i = 0; i < image.packed.length; ++i) {
      if (image.nan.has(i)) continue;
      Images.unpack(image.packed, i, rgb);
      sum += rgb[0] + rgb[1] + rgb[2];
    }
    return sum / (3 * Math.max(1, image.packed.length - image.nan.size));
  }

  function scale_of(error) {
    const sorted = error.filter(Number.isFinite).sort();
    const worst = sorted[Math.floor(((sorted.length - 1) * 99) / 100)];
    if (!(worst > 0)) return 1;
    const decade = 10 ** Math.floor(Math.log10(worst));
    const step = [1, 2, 5, 10].find((s) => worst <= s * decade * (1 + 1e-6));
    return Number((step * decade).toPrecision(3));
  }

  const stops = kInferno.map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));

  function error_map(image, error, high) {
    return paint(image, (i, rgb) => {
      if (Number.isNaN(error[i])) return rgb.splice(0, 3, ...kNan);
      const place = Math.min(1, error[i] / high) * (stops.length - 1),
        below = Math.min(Math.floor(place), stops.length - 2);
      for (let c = 0; c < 3; ++c)
        rgb[c] = stops[below][c] + (place - below) * (stops[below + 1][c] - stops[below][c]);
    });
  }

  /// The colours for CSS, low to high.
  const gradient = (direction) => `linear-gradient(${direction}, ${kInferno.join(", ")})`;

  return {error_map, gradient, picture, relative_error};
})();
