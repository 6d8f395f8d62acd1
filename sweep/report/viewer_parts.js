"use strict";
// The elements of the image viewer and the keys it answers; what they do is in `actions`, of viewer.js.

/// {frame: all of it, canvas, stage: around the canvas, labels: two, legend: the error scale, read: the line below, mode,
/// shows, scene, stops, stops_text, scale: controls}
function viewer_parts({scenes, modes, state, pickers: [a, b], actions}) {
  const button = (label, title, onclick, name = null) =>
    h("button", {type: "button", class: name, title, "aria-label": title || null, onclick}, label);
  const contents = [
    {value: "picture", label: "Picture"},
    {value: "error", label: "Error map", title: "E"},
  ];
  const ends = [0.05, 0.1, 0.2, 0.5, 1, 2, 5];
  const parts = {};

  parts.mode = segments("Mode", modes, state.mode, actions.set_mode);
  parts.shows = segments("Show", contents, state.shows, actions.set_shows);
  const set_stops = () => actions.set_stops(Number(parts.stops.value));
  parts.stops = h("input", {
    type: "range",
    min: -8,
    max: 8,
    step: 0.25,
    "aria-label": "Exposure in stops",
    oninput: set_stops,
  });
  parts.stops_text = h("output");
  parts.scale = h(
    "select",
    {
      "aria-label": "Upper end of the error scale",
      onchange: () => actions.set_scale(Number(parts.scale.value) || null),
    },
    h("option", {value: ""}, "scale: 99 % of pixels"),
    ends.map((v) => h("option", {value: v}, `scale: 0 to ${v}`)),
  );
  parts.scene = h(
    "select",
    {class: "scene", "aria-label": "Scene of the pictures", onchange: () => actions.show_scene(parts.scene.value)},
    scenes.map((scene) => h("option", {value: scene.id}, scene.name)),
  );
  const zooming = h(
    "span",
    {class: "segments"},
    button("−", "Zoom out", () => actions.zoom(1 / 2)),
    button("+", "Zoom in", () => actions.zoom(2)),
    button("1:1", "A pixel of the picture on one of the screen", actions.one_to_one),
    button("Fit", "Whole picture (R)", actions.fit),
  );
  const exposure = h("label", {class: "exposure"}, "Exposure ", parts.stops, parts.stops_text);

  parts.canvas = h("canvas", {tabindex: 0, role: "img", "aria-label": "Picture", "aria-describedby": "viewer-keys"});
  parts.labels = [0, 1].map(() => h("span", {class: "label"}));
  parts.stage = h("div", {class: "stage"}, parts.canvas, parts.labels);
  parts.legend = h("div", {class: "scale", "aria-hidden": "true"});
  parts.read = h("output", {class: "readout"});
  parts.frame = h(
    "figure",
    {class: "viewer", onkeydown: (event) => viewer_key(event, parts.canvas, actions)},
    h(
      "div",
      {class: "bar"},
      parts.mode,
      parts.shows,
      exposure,
      parts.scale,
      zooming,
      button("Full screen", "", actions.full_screen),
    ),
    h(
      "div",
      {class: "bar"},
      scenes.length > 1 ? parts.scene : null,
      a.element,
      button("⇄", "Exchange A and B (X)", actions.exchange, "exchange"),
      b.element,
    ),
    h("div", {class: "stage-row"}, parts.stage, parts.legend),
    parts.read,
    viewer_help(),
  );
  return parts;
}

function viewer_help() {
  const help = [
    ["F, space", "flip between A and B"],
    ["1 … 9", "a method on side A (again: its next parameters); with Shift on side B"],
    ["0", "the reference on side A; with Shift on side B"],
    ["X", "exchange A and B"],
    ["E", "picture or error map"],
    ["+ −", "exposure, half a stop"],
    ["wheel, pinch, double click", "zoom in, out, whole picture"],
    ["R", "whole picture"],
    ["arrows", "move; with Shift the bar of the split"],
    ["M", "next mode"],
  ];
  const lines = help.map(([keys, what]) => h("div", {}, h("kbd", {}, keys), ` ${what}`));
  return h(
    "details",
    {id: "viewer-keys", class: "note"},
    h("summary", {}, "Keys and pointer"),
    h("div", {class: "keys"}, lines),
  );
}

function viewer_key(event, canvas, actions) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  // Selects, buttons and sliders keep the keys that are theirs.
  const own =
    event.target.tagName === "SELECT" || event.key === " " || event.key.startsWith("Arrow") || event.key === "Enter";
  if (event.target !== canvas && own) return;
  const letters = {
    f: actions.flip,
    " ": actions.flip,
    x: actions.exchange,
    e: actions.error_map,
    r: actions.fit,
    m: actions.next_mode,
    "+": () => actions.exposure(0.5),
    "=": () => actions.exposure(0.5),
    "-": () => actions.exposure(-0.5),
  };
  const action = letters[event.key.toLowerCase()];
  // By the key's place, since Shift turns digits into other signs.
  const digit = /^(?:Digit|Numpad)(\d)$/.exec(event.code)?.[1];
  const arrow = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
  if (digit) actions.choose(Number(digit), event.shiftKey);
  else if (action) action();
  else if (arrow && event.shiftKey) actions.move_bar(-0.02 * arrow[0]);
  else if (arrow) actions.pan(48 * arrow[0], 48 * arrow[1]);
  else return;
  event.preventDefault();
}
