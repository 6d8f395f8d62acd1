// Makes the points of a chart hoverable, clickable and reachable by Tab: pointers take the nearest point, so that small
// markers need no aim; Enter and Space press the focused one.

const kReach = 28; // px: how far from a point the pointer may be

/// `points[i]`: {px, py} in the chart's pixels, and whatever the caller wants back. `elements[i]`, optional: the marker
/// to focus. `on_hover(point or null, client position)`, `on_pick(point)`.
export function make_interactive(svg, points, elements, {on_hover, on_pick}) {
  // Where the svg is scaled by its style (in print, say), its own units are not the screen's pixels.
  const scale = () => svg.getBoundingClientRect().width / svg.viewBox.baseVal.width || 1;
  const client = (p) => {
    const box = svg.getBoundingClientRect();
    return {x: box.left + p.px * scale(), y: box.top + p.py * scale()};
  };
  const nearest = (event) => {
    const box = svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / scale(),
      y = (event.clientY - box.top) / scale();
    let best = null,
      distance = kReach;
    for (const p of points) {
      const d = Math.hypot(p.px - x, p.py - y);
      if (d < distance) [best, distance] = [p, d];
    }
    return best;
  };

  let hovered = null;
  const hover = (point) => {
    if (point === hovered) return;
    elements?.[points.indexOf(hovered)]?.classList.remove("active");
    hovered = point;
    elements?.[points.indexOf(point)]?.classList.add("active");
    svg.style.cursor = point ? "pointer" : "";
    on_hover(point, point && client(point));
  };
  svg.addEventListener("pointermove", (event) => hover(nearest(event)));
  svg.addEventListener("pointerleave", () => hover(null));
  svg.addEventListener("click", (event) => {
    const point = nearest(event);
    if (point) on_pick(point);
  });

  elements?.forEach((element, i) => {
    element.setAttribute("tabindex", "0");
    element.setAttribute("role", "button");
    element.setAttribute("aria-label", points[i].name);
    element.addEventListener("focus", () => hover(points[i]));
    element.addEventListener("blur", () => hover(null));
    element.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      on_pick(points[i]);
    });
  });
}
