"use strict";
// Elements from code. Text becomes text nodes, never markup, so that no name in a result can do anything but be read.

/// h("button", {class: "x", onclick: f, "aria-pressed": "true"}, "text", element, [more]): null and false are left out.
function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/// A row of buttons of which one is pressed. options: [{value, label, title}]; on_choose(value) when that changes.
/// Call `choose(value)` on the result to press one from code, silently.
function segments(name, options, chosen, on_choose) {
  const group = h("div", {class: "segments", role: "group", "aria-label": name});
  const buttons = new Map();
  for (const {value, label, title} of options) {
    const press = () => {
      group.choose(value);
      on_choose(value);
    };
    const button = h("button", {type: "button", title, onclick: press, "data-value": value}, label);
    buttons.set(value, button);
    group.append(button);
  }
  group.choose = (value) => buttons.forEach((button, v) => button.setAttribute("aria-pressed", String(v === value)));
  group.choose(chosen);
  return group;
}

/// Calls `draw` when the element's width has changed, as soon as the page has time; a first time at once.
function on_resize(element, draw) {
  let width = null;
  new ResizeObserver(() => {
    if (element.clientWidth === width) return;
    width = element.clientWidth;
    requestAnimationFrame(draw);
  }).observe(element);
}
