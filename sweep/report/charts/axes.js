// Axes shared by all charts: scales that show a zero on a log axis, ticks a reader can name, and a faint grid.
//
//     const y = make_axis([0.02, 0.5, 0], "log");
//     plot({y: y.scale, marks: [...axis_marks("y", y, "RMSE"), dot(data, {y: d => y.place(d.error)})]});

import {axisX, axisY, gridX, gridY} from "@observablehq/plot";

/// `values`: all that must fit; nulls are skipped. `kind`: "log" or "linear"; `reverse`: larger is nearer the origin.
/// `place` maps a value to where it is drawn: a zero has no place on a log axis and gets a row of its own below.
/// `beyond` tells whether a value lies outside at the end that is drawn lowest. `extra`: values that are worth at most
/// a decade of the axis, or half of what it spans.
export function make_axis(values, kind, reverse = false, extra = []) {
  const finite = (list) => list.filter((v) => v !== null && v !== undefined && Number.isFinite(v));
  const all = finite(values),
    low = Math.min(...all.filter((v) => v > 0 || kind !== "log")),
    high = Math.max(...all);
  const near =
    kind === "log"
      ? (v) => v > low / 10 && v < high * 10
      : (v) => v > low - (high - low) / 2 && v < high + (high - low) / 2;
  const used = [...all, ...finite(extra).filter(near)];
  const axis = kind === "log" ? log_axis(used, reverse) : linear_axis(used, reverse);
  axis.beyond = (v) => (reverse ? v > axis.domain[1] : v < axis.domain[0]);
  return axis;
}

function log_axis(values, reverse) {
  const positive = values.filter((v) => v > 0);
  let low = positive.length ? Math.min(...positive) : 0.1,
    high = positive.length ? Math.max(...positive) : 1;
  // A single value, or values next to each other, get a third of a decade to stand in.
  const narrow = 2 / Math.max(high / low, 1);
  const pad = narrow > 1 ? Math.sqrt(narrow) : Math.pow(high / low, 0.07);
  low /= pad;
  high *= pad;
  const has_zero = values.some((v) => v === 0);
  const zero = low / Math.pow(high / low, 0.1);
  const ticks = log_ticks(low, high);
  const domain = [has_zero ? zero / Math.pow(high / low, 0.04) : low, high];
  if (has_zero) ticks.unshift(zero);
  return {
    scale: {type: "log", domain, reverse},
    domain,
    ticks,
    format: (v) => (has_zero && v === zero ? "0" : tick_text(v)),
    place: (v) => (v === 0 && has_zero ? zero : Math.max(v, domain[0])),
  };
}

function linear_axis(values, reverse) {
  let low = values.length ? Math.min(...values) : 0,
    high = values.length ? Math.max(...values) : 1;
  const pad = high > low ? 0.07 * (high - low) : 0.1 * Math.abs(high) || 1;
  low -= pad;
  high += pad;
  const ticks = linear_ticks(low, high);
  return {
    scale: {type: "linear", domain: [low, high], reverse},
    domain: [low, high],
    ticks,
    format: tick_text,
    place: (v) => v,
  };
}

/// Powers of ten; with 2 and 5 between them where there is room; evenly spaced ones within a factor of two or so.
function log_ticks(low, high) {
  const decades = Math.log10(high / low);
  if (decades < 0.5) return linear_ticks(low, high);
  const factors = decades > 2.5 ? [1] : decades > 1.2 ? [1, 3] : [1, 2, 3, 5, 7];
  const ticks = [];
  for (let n = Math.floor(Math.log10(low)); n <= Math.ceil(Math.log10(high)); ++n) {
    for (const factor of factors) {
      const tick = Number(`${factor}e${n}`);
      if (tick >= low && tick <= high) ticks.push(tick);
    }
  }
  // Over many decades, every second or third power is enough.
  const every = Math.ceil(ticks.length / 8);
  return ticks.filter((_, i) => i % every === 0);
}

function linear_ticks(low, high) {
  const rough = (high - low) / 4,
    decade = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map((f) => f * decade).find((s) => s >= rough * 0.9);
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

function tick_text(v) {
  const size = Math.abs(v);
  if (size !== 0 && (size < 1e-4 || size >= 1e5)) return v.toExponential().replace("e+", "e").replace("-", "−");
  return String(v).replace("-", "−");
}

/// Grid and labelled axis of `dimension` "x" or "y". The label stands where Plot puts it: the arrow end of the axis.
export function axis_marks(dimension, axis, label) {
  const grid = dimension === "x" ? gridX : gridY,
    draw = dimension === "x" ? axisX : axisY;
  const options = {ticks: axis.ticks, tickFormat: axis.format, tickSize: 4, fontSize: 11, label: null};
  return [
    grid(axis.ticks, {className: "grid"}),
    draw({...options, label, labelArrow: "none", labelOffset: dimension === "x" ? 34 : undefined}),
  ];
}
