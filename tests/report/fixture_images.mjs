// Pictures for the fixture: a sphere on a checkered floor under a sky with a sun far brighter than 1, and the RGB9E5
// encoding of what reports keep. The encoder is written after the format's text, not after the page's decoder.

/// {width, height, rgb: Float64Array}; `hue` tells scenes apart.
export function draw_scene(hue, width, height) {
  const rgb = new Float64Array(3 * width * height);
  const tint = [
    [1, 0.8, 0.6],
    [0.6, 0.9, 1],
    [0.8, 1, 0.7],
  ][hue % 3];
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const u = (x + 0.5 - width / 2) / height,
        v = (y + 0.5) / height - 0.5;
      const color = shade(u, v);
      for (let c = 0; c < 3; ++c) rgb[3 * (y * width + x) + c] = color * tint[c];
    }
  }
  return {width, height, rgb};
}

function shade(u, v) {
  const inside = 0.09 - (u * u + (v - 0.05) ** 2);
  if (inside > 0) {
    const z = Math.sqrt(inside),
      n = [u / 0.3, (v - 0.05) / 0.3, z / 0.3];
    const lit = Math.max(0, -0.5 * n[0] - 0.6 * n[1] + 0.62 * n[2]);
    return 0.05 + 0.9 * lit + 30 * lit ** 200;
  }
  if (v > 0.12) {
    const depth = 1 / (v - 0.02),
      light = (Math.floor(u * depth * 1.5 + 50) + Math.floor(depth * 1.5)) & 1;
    return (light ? 0.6 : 0.15) * (0.4 + v) * (u * u + (v - 0.35) ** 2 < 0.05 ? 0.35 : 1);
  }
  return 0.25 - 0.3 * v + ((u + 0.6) ** 2 + (v + 0.38) ** 2 < 0.003 ? 120 : 0);
}

export function with_noise({width, height, rgb}, amount, next) {
  return {width, height, rgb: rgb.map((v) => Math.max(0, v * (1 + amount * (next() + next() + next() - 1.5))))};
}

/// Base64 of a little-endian word a pixel: mantissas of 9 bits r | g << 9 | b << 18 and a shared exponent << 27, bias 15.
export function pack({rgb}) {
  const words = Buffer.alloc((rgb.length / 3) * 4);
  for (let i = 0; i < rgb.length / 3; ++i) {
    const pixel = [rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]].map((v) => Math.min(v, 65408));
    const largest = Math.max(...pixel);
    let exponent = Math.max(-16, largest > 0 ? Math.floor(Math.log2(largest)) : -16) + 16;
    if (Math.round(largest / 2 ** (exponent - 24)) === 512) ++exponent; // rounding up leaves the nine bits
    const [r, g, b] = pixel.map((v) => Math.round(v / 2 ** (exponent - 24)));
    words.writeUInt32LE(((exponent << 27) | (b << 18) | (g << 9) | r) >>> 0, 4 * i);
  }
  return words.toString("base64");
}
