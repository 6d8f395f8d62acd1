"use strict";
// Numbers, units and parameters as people read them.

const Format = (() => {
  /// Three significant digits: 0.0912, 12.3, 1.2e−6; "–" for what was not measured, "∞" for infinities.
  function number(value, digits = 3) {
    if (value === null || value === undefined || value === "") return "–";
    if (value === "inf" || value === Infinity) return "∞";
    if (typeof value !== "number" || Number.isNaN(value)) return String(value);
    if (value === 0) return "0";
    const size = Math.abs(value);
    // Close to 1 it is the distance from it that tells scores like SSIM apart: 0.99987.
    if (size > 0.99 && size < 1)
      return value.toFixed(Math.min(9, digits - 2 - Math.floor(Math.log10(1 - size) + 1e-9))).replace("-", "−");
    const text =
      size < 1e-4 || size >= 1e6
        ? value.toExponential(digits - 1).replace("e+", "e")
        : size >= 1000
          ? String(Math.round(value))
          : value.toPrecision(digits);
    return text.replaceAll("-", "−");
  }

  /// Half the width of an interval around its mean; both ends where it is lopsided.
  function interval(bounds) {
    const {mean, low, high} = bounds ?? {};
    if (low === null || low === undefined || high === null || high === undefined) return "–";
    const up = high - mean,
      down = mean - low;
    if (Math.abs(up - down) <= 0.05 * (up + down)) return `± ${number((up + down) / 2, 2)}`;
    return `${number(low)} … ${number(high)}`;
  }

  /// "W m^-2 sr^-1" -> "W m⁻² sr⁻¹"
  function unit(text) {
    const raised = {"-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹"};
    return (text || "").replace(/\^(-?\d+)/g, (_, digits) => [...digits].map((d) => raised[d]).join(""));
  }

  /// {lights: 400, bounces: 1} -> "lights 400, bounces 1"
  function parameters(values) {
    return Object.entries(values || {})
      .map(([name, value]) => `${name.replaceAll("_", " ")} ${plain(value)}`)
      .join(", ");
  }

  function plain(value) {
    if (typeof value === "number")
      return Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(6)));
    return typeof value === "string" ? value : JSON.stringify(value);
  }

  /// 3.2 s, 4 min 10 s, 2 h 5 min
  function duration(seconds) {
    if (seconds === null || seconds === undefined) return "–";
    if (seconds < 60) return `${number(seconds)} s`;
    const minutes = Math.round(seconds / 60);
    if (minutes < 10) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
    return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
  }

  const count = (n, noun, plural = `${noun}s`) => `${n} ${n === 1 ? noun : plural}`;

  return {count, duration, interval, number, parameters, plain, unit};
})();
