// Marks that several charts share: interval bars, and markers by shape.

import {dot, link, plot, ruleY, text} from "@observablehq/plot";

const kCap = 10; // px, half the width of a cap; markers reach 5 to 8 px

/// Bars with caps, in the point's colour and with a rim of the page's: `horizontal` and `vertical` ones, [{at, low, high,
/// color}]. They lie under the markers and their caps are wider than any marker, so that the interval of a marker that
/// hides it still shows on both sides: as two lines, or as one where nothing can be told from zero.
export function interval_bars(horizontal, vertical = []) {
  const along_x = {x1: "low", x2: "high", y1: "at", y2: "at"},
    along_y = {x1: "at", x2: "at", y1: "low", y2: "high"};
  const layer = (stroke, strokeWidth) => {
    const options = {className: "interval", stroke, strokeWidth};
    return [
      link(horizontal, {...along_x, ...options, marker: cap(true, strokeWidth)}),
      link(vertical, {...along_y, ...options, marker: cap(false, strokeWidth)}),
    ];
  };
  return [...layer("var(--surface)", 3), ...layer("color", 1.3)];
}

/// A line across the end of a bar. It turns with the kind of bar, since a bar of no length has no direction.
function cap(horizontal, width) {
  return (color, context) => {
    const make = (name, attributes) => {
      const node = context.document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
      return node;
    };
    const size = 2 * kCap + 2;
    const marker = make("marker", {
      viewBox: `${-size / 2} ${-size / 2} ${size} ${size}`,
      markerWidth: size,
      markerHeight: size,
      markerUnits: "userSpaceOnUse",
      orient: "0",
      stroke: color,
      "stroke-width": width,
    });
    marker.append(make("path", {d: horizontal ? `M0,${-kCap}V${kCap}` : `M${-kCap},0H${kCap}`}));
    return marker;
  };
}

/// Filled markers; hollow ones for what the reference limits. Both on a disc of the page's colour, which keeps their
/// shape apart from the bars behind.
export function markers(points, options) {
  return [
    dot(points, {
      ...options,
      symbol: "shape",
      r: 5.2,
      fill: "var(--surface)",
      stroke: "var(--surface)",
      strokeWidth: 3.2,
    }),
    dot(points, {
      ...options,
      className: "points",
      symbol: "shape",
      r: 5,
      stroke: "color",
      strokeWidth: 1.6,
      fill: (p) => (p.hollow ? "var(--surface)" : p.color),
    }),
  ];
}

/// Dotted lines at the references' own error; one far below everything else is a word at the edge, since a line there
/// would squeeze the points together.
export function floor_marks(floors, axis) {
  const near = floors.filter((f) => !axis.beyond(f.value)),
    far = floors.filter((f) => axis.beyond(f.value));
  const words = {frameAnchor: "bottom-left", textAnchor: "start", dx: 4, className: "floor-label", fontSize: 11};
  return [
    ruleY(near, {y: (f) => axis.place(f.value), className: "floor", strokeDasharray: "2,4", strokeWidth: 1.4}),
    text(near, {...words, y: (f) => axis.place(f.value), text: "label", frameAnchor: "left", dy: -7}),
    ...far.map((f, i) => text([f], {...words, text: () => `↓ ${f.label}`, dy: -6 - 13 * i})),
  ];
}

/// A marker alone, for legends: an svg of 14 px.
export function icon(shape, color) {
  const mark = dot([0], {frameAnchor: "middle", symbol: shape, fill: color, stroke: color, r: 4.5});
  const svg = plot({width: 14, height: 14, margin: 0, axis: null, marks: [mark]});
  svg.setAttribute("aria-hidden", "true");
  return svg;
}
