// Stability: every seed's score on one line a group, the interval of the mean below it and the worst seed ringed.

import {dot, plot, text} from "@observablehq/plot";

import {axis_marks, make_axis} from "./axes.js";
import {make_interactive} from "./interact.js";
import {interval_bars} from "./marks.js";

const kRow = 40; // px a group

/// spec: {width, x_label, x_kind, x_reverse, on_hover, on_pick, rows: [{label, color, shape, mean, low, high,
///        seeds: [{value, worst, name}]}]}. Seeds come back in hover and pick with what else they hold.
export function strips(spec) {
  const {rows} = spec;
  const x = make_axis(
    rows.flatMap((r) => [r.mean, r.low > 0 ? r.low : null, r.high, ...r.seeds.map((s) => s.value)]),
    spec.x_kind,
    spec.x_reverse,
  );
  const seeds = rows.flatMap((r, row) =>
    r.seeds.map((s) => ({...s, row, color: r.color, shape: r.shape, at: x.place(s.value)})),
  );
  const marginTop = 4,
    marginBottom = 42;
  const intervals = rows
    .map((r, row) => ({
      at: row,
      low: x.place(r.low),
      high: x.place(r.high),
      color: r.color,
      known: r.low !== null && r.high !== null,
    }))
    .filter((bar) => bar.known);
  const svg = plot({
    width: spec.width,
    height: rows.length * kRow + marginTop + marginBottom,
    marginLeft: 10,
    marginRight: 14,
    marginTop,
    marginBottom,
    x: x.scale,
    color: {type: "identity"},
    // Rows are numbers rather than bands: the labels stand above their row, so that narrow screens have room for both.
    y: {domain: [-0.7, rows.length - 0.45], range: [marginTop, rows.length * kRow + marginTop], axis: null},
    marks: [
      ...axis_marks("x", x, spec.x_label),
      text(rows, {
        y: (_, i) => i,
        text: "label",
        frameAnchor: "left",
        textAnchor: "start",
        dy: -16,
        className: "strip-label",
        fontSize: 11.5,
      }),
      ...interval_bars(intervals),
      dot(seeds, {
        x: "at",
        y: "row",
        symbol: "shape",
        r: 4,
        fill: "color",
        fillOpacity: 0.55,
        stroke: "color",
        className: "points",
      }),
      dot(
        seeds.filter((s) => s.worst),
        {x: "at", y: "row", r: 8, className: "worst", strokeWidth: 1.2},
      ),
    ],
  });
  for (const s of seeds) [s.px, s.py] = [svg.scale("x").apply(s.at), svg.scale("y").apply(s.row)];
  make_interactive(svg, seeds, [...svg.querySelectorAll("g.points > *")], spec);
  return svg;
}
