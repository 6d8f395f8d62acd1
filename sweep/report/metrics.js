"use strict";
// What each metric is called and on which axis it stands. Every chart has the better pictures at the bottom, so scores
// of which more is better turn round: 1 − SSIM on a log axis, PSNR, logarithmic already, on a reversed one.

const Metrics = (() => {
  const kNames = {
    rmse: "RMSE",
    mae: "MAE",
    relmse: "relMSE",
    relmse_trimmed: "relMSE, trimmed",
    smape: "SMAPE",
    psnr: "PSNR",
    ssim: "SSIM",
    flip: "FLIP",
    flip_hdr: "HDR-FLIP",
    nan: "NaN pixels",
  };

  /// A score's key in `scores`; the name, unless the results tell two metrics of one name apart.
  const key = (metric) => metric.key ?? metric.name;

  function label(metric) {
    const name = metric.name.replace(/_(display|linear)$/, "");
    const shown = kNames[name] ?? name.replaceAll("_", " ");
    // Only RMSE and MAE exist on both kinds of values.
    return metric.values === "display" && (name === "rmse" || name === "mae") ? `${shown}, display values` : shown;
  }

  const with_unit = (name, unit) => (unit ? `${name} (${Format.unit(unit)})` : name);
  const heading = (metric) => with_unit(label(metric), metric.unit);

  /// {label, kind: "log" | "linear", reverse, value(score), better(a, b) on such values}
  function axis(metric) {
    const smaller = (a, b) => a < b;
    if (metric.unit === "dB")
      return {label: heading(metric), kind: "linear", reverse: true, value: finite, better: (a, b) => a > b};
    if (metric.better === "higher")
      return {
        label: `1 − ${label(metric)}`,
        kind: "log",
        value: (score) => map(score, (v) => 1 - v),
        better: smaller,
      };
    if (metric.name === "bias")
      return {
        label: with_unit("|bias|", metric.unit),
        kind: "log",
        value: (score) => map(score, Math.abs),
        better: smaller,
      };
    return {label: heading(metric), kind: "log", value: finite, better: smaller};
  }

  /// Infinite scores (PSNR of equal pictures) have no place on an axis.
  const finite = (score) => (typeof score === "number" && Number.isFinite(score) ? score : null);
  const map = (score, change) => (finite(score) === null ? null : change(score));

  /// The ends of a group's interval on the axis, lower one first; nulls where there is none.
  function bounds(of_axis, score) {
    const ends = [of_axis.value(score?.low), of_axis.value(score?.high)];
    if (ends.includes(null)) return [null, null];
    // A bias whose interval holds zero comes from below: its size reaches down to zero.
    if (of_axis.label.startsWith("|") && score.low < 0 && score.high > 0) return [0, Math.max(...ends)];
    return ends.sort((a, b) => a - b);
  }

  const unit = (metric) => Format.unit(metric.unit);

  return {axis, bounds, heading, key, label, unit};
})();
