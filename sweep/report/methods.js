"use strict";
// How a method looks everywhere on the page: a colour and a shape each, so that neither has to be told apart alone.

const Methods = (() => {
  // Eight colours are in style.css (--m0 to --m7, other ones in dark mode); shapes go round out of step with them.
  const kShapes = ["circle", "square", "triangle", "diamond", "triangle2", "star", "hexagon", "wye"];

  const color = (method) => `var(--m${method.index % 8})`;
  const shape = (method) => kShapes[(method.index + Math.floor(method.index / 8) * 3) % 8];

  function icon(method) {
    if (window.ZonalCharts) return ZonalCharts.icon(shape(method), color(method));
    const swatch = h("span", {class: "swatch"});
    swatch.style.background = color(method);
    return swatch;
  }

  /// Icon and label.
  const name = (method) => h("span", {class: "method"}, icon(method), h("span", {}, method.label ?? method.id));

  return {color, icon, name, shape};
})();
