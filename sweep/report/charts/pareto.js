// Error against time: a point with interval bars for each group of seeds, a line through what a method varies, the
// front behind them and the references' floors.

import {line, plot} from "@observablehq/plot";

import {axis_marks, make_axis} from "./axes.js";
import {make_interactive} from "./interact.js";
import {floor_marks, interval_bars, markers} from "./marks.js";

/// spec: {width, height, x_label, y_label, y_kind: "log" | "linear", y_reverse,
///        points: [{x, x_low, x_high, y, y_low, y_high, color, shape, hollow, dashed, line, name}],
///        front: [{x, y}] by rising x, floors: [{value, label}], on_hover, on_pick}. Bounds may be null: no bar.
export function pareto(spec) {
  const {points, front, floors} = spec;
  const x = make_axis(
    points.flatMap((p) => [p.x, p.x_low > 0 ? p.x_low : null, p.x_high]),
    "log",
  );
  const y = make_axis(
    points.flatMap((p) => [p.y, p.y_high, p.y_low > p.y / 10 || p.y_low === 0 ? p.y_low : null]),
    spec.y_kind,
    spec.y_reverse,
    floors.map((f) => f.value),
  );
  const at = (p) => ({...p, x: x.place(p.x), y: y.place(p.y)});
  const placed = points.map(at);

  // The front goes on level to the right edge: more time makes nothing worse.
  const steps = front.map(at);
  if (steps.length) steps.push({...steps.at(-1), x: x.domain[1]});

  // A line of one point is none; Plot draws those of each `line` apart.
  const lines = ["", "5,3"].map((dashes) =>
    line(
      placed.filter((p) => p.dashed === (dashes !== "")),
      {x: "x", y: "y", z: "line", stroke: "color", strokeWidth: 1.6, strokeDasharray: dashes, className: "lines"},
    ),
  );
  const svg = plot({
    width: spec.width,
    height: spec.height,
    marginLeft: 52,
    marginRight: 14,
    marginTop: 26,
    marginBottom: 42,
    x: x.scale,
    y: y.scale,
    color: {type: "identity"},
    marks: [
      ...axis_marks("x", x, spec.x_label),
      ...axis_marks("y", y, spec.y_label),
      line(steps, {x: "x", y: "y", curve: "step-after", className: "front", strokeWidth: 7, clip: true}),
      ...floor_marks(floors, y),
      ...lines,
      ...interval_bars(bars(placed, "y", "x", x.place), bars(placed, "x", "y", y.place)),
      ...markers(placed, {x: "x", y: "y"}),
    ],
  });
  for (const p of placed) [p.px, p.py] = [svg.scale("x").apply(p.x), svg.scale("y").apply(p.y)];
  make_interactive(svg, placed, [...svg.querySelectorAll("g.points > *")], spec);
  return svg;
}

function bars(points, at, along, place) {
  return points
    .filter((p) => Number.isFinite(p[`${along}_low`] ?? NaN) && Number.isFinite(p[`${along}_high`] ?? NaN))
    .map((p) => ({at: p[at], low: place(p[`${along}_low`]), high: place(p[`${along}_high`]), color: p.color}));
}
