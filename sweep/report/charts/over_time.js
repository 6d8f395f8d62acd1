// Error over time: how the picture of each group converges pass by pass; seeds thin, their mean strong. A group that
// was scored once only is a curve of one point.

import {dot, line, plot} from "@observablehq/plot";

import {axis_marks, make_axis} from "./axes.js";
import {make_interactive} from "./interact.js";
import {floor_marks} from "./marks.js";

/// spec as of `pareto`, without front, and `curves`: [{points: [{x, y, name}], color, shape, mean: bool, dashed}].
/// Only the points of means answer to the pointer.
export function over_time(spec) {
  const {curves, floors} = spec;
  const all = curves.flatMap((curve, i) => curve.points.map((p) => ({...p, curve: i, ...style_of(curve)})));
  const x = make_axis(
    all.map((p) => p.x),
    "log",
  );
  const y = make_axis(
    all.map((p) => p.y),
    spec.y_kind,
    spec.y_reverse,
    floors.map((f) => f.value),
  );
  for (const p of all) [p.x, p.y] = [x.place(p.x), y.place(p.y)];
  const means = all.filter((p) => p.mean),
    seeds = all.filter((p) => !p.mean);

  const channels = {x: "x", y: "y", z: "curve", stroke: "color"};
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
      ...floor_marks(floors, y),
      line(seeds, {...channels, strokeWidth: 1, strokeOpacity: 0.35}),
      ...["", "5,3"].map((dashes) =>
        line(
          means.filter((p) => p.dashed === (dashes !== "")),
          {...channels, strokeWidth: 2, strokeDasharray: dashes},
        ),
      ),
      dot(means, {
        x: "x",
        y: "y",
        symbol: "shape",
        fill: "color",
        stroke: "var(--surface)",
        r: 4,
        className: "points",
      }),
    ],
  });
  for (const p of means) [p.px, p.py] = [svg.scale("x").apply(p.x), svg.scale("y").apply(p.y)];
  make_interactive(svg, means, [...svg.querySelectorAll("g.points > *")], spec);
  return svg;
}

const style_of = ({color, shape, mean, dashed, group}) => ({color, shape, mean, dashed, group});
