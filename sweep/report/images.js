"use strict";
// Pictures, loaded when they are looked at. Each is a script that calls zonal_image(id, {...}), since a page from the
// file system may not read other files. They are kept packed, 4 bytes a pixel, and the ones not looked at for longest
// are let go.

const Images = (() => {
  const limit = {bytes: 256e6, least: 4}; // packed pixels kept, and how many pictures are in any case: A and B with theirs
  const kept = new Map(); // file -> image, in the order of use
  const loading = new Map(); // file -> promise

  /// {width, height, exposure, packed: Uint32Array of RGB9E5, nan: Set of pixel indices}; rejects with a sentence.
  function load(file) {
    if (kept.has(file)) {
      const image = kept.get(file);
      kept.delete(file);
      kept.set(file, image);
      return Promise.resolve(image);
    }
    if (!loading.has(file))
      loading.set(
        file,
        start(file).finally(() => loading.delete(file)),
      );
    return loading.get(file);
  }

  const ready = (file) => kept.get(file) ?? null;

  function start(file) {
    return new Promise((resolve, reject) => {
      const script = h("script", {src: file, "data-file": file});
      script.onerror = () => reject(new Error(`${file} is missing or cannot be read`));
      // The script has called zonal_image by now, if it holds what it should.
      script.onload = () =>
        kept.has(file)
          ? resolve(kept.get(file))
          : reject(new Error(problems.get(file) ?? `${file} holds no picture`));
      document.head.append(script);
      script.addEventListener("load", () => script.remove());
      script.addEventListener("error", () => script.remove());
    });
  }

  const problems = new Map();

  /// Image scripts call this; one that stands in the page itself is known by its id.
  window.zonal_image = (id, {width, height, exposure, data, nan}) => {
    const file = document.currentScript?.dataset.file ?? `images/${id}.js`;
    const bytes = decode_base64(data);
    if (bytes.length !== 4 * width * height) {
      problems.set(file, `${file} is cut off: ${bytes.length} bytes of ${4 * width * height}`);
      return;
    }
    kept.set(file, {
      width,
      height,
      exposure: exposure ?? 1,
      packed: new Uint32Array(bytes.buffer),
      nan: new Set(nan ?? []),
    });
    let sum = 0;
    for (const image of kept.values()) sum += image.packed.byteLength;
    for (const [oldest, image] of kept) {
      if (sum <= limit.bytes || kept.size <= limit.least) break;
      kept.delete(oldest);
      sum -= image.packed.byteLength;
    }
  };

  function decode_base64(text) {
    const characters = atob(text),
      bytes = new Uint8Array(characters.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
    return bytes;
  }

  // A channel is mantissa * 2^(exponent - 15 - 9) (EXT_texture_shared_exponent).
  const kScales = Float64Array.from({length: 32}, (_, exponent) => 2 ** (exponent - 24));

  /// Linear radiance of pixel `i` into `rgb`.
  function unpack(packed, i, rgb) {
    const bits = packed[i],
      scale = kScales[bits >>> 27];
    rgb[0] = (bits & 511) * scale;
    rgb[1] = ((bits >>> 9) & 511) * scale;
    rgb[2] = ((bits >>> 18) & 511) * scale;
  }

  return {limit, load, ready, unpack};
})();
