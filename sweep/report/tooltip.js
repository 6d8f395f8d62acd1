"use strict";
// The box beside a hovered or focused point.

const Tooltip = (() => {
  const box = document.getElementById("tooltip");

  /// `rows`: [[name, value], ...]; `at`: position in the window, px.
  function show(title, rows, at) {
    box.replaceChildren(
      h("strong", {}, title),
      h(
        "dl",
        {},
        rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))),
      ),
    );
    box.hidden = false;
    // Beside the point, on whichever side there is room, and never under the pointer.
    const {width, height} = box.getBoundingClientRect(),
      gap = 16;
    const left = at.x + gap + width < window.innerWidth ? at.x + gap : Math.max(4, at.x - gap - width);
    const top = Math.min(Math.max(4, at.y - height / 2), window.innerHeight - height - 4);
    box.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
  }

  const hide = () => (box.hidden = true);
  window.addEventListener("scroll", hide, {passive: true});

  return {hide, show};
})();
