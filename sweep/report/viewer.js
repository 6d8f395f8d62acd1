"use strict";
// The image viewer: two pictures, A and B, of one scene, shown alone, in turn, split or side by side, as they look or
// as maps of their relative error.

const Viewer = (() => {
  const kModes = [{value: "single", label: "Single"}, {value: "flip", label: "Flip", title: "F or space changes sides"},
                  {value: "split", label: "Split", title: "Drag the bar"}, {value: "side", label: "Side by side"}];
  const state = {scene: null, mode: "split", shows: "picture", stops: 0, flipped: false, scale: null, loaded: Promise.resolve()};
  const parts = {};       // the elements
  const maps = new Map(); // "file of picture|file of truth" -> relative error; the last four
  const toned = [null, null];  // what each side was last painted from: {key, picture}
  let page, view, a, b, cursor = null;

  function set_up(its_page) {
    page = its_page;
    const scenes = page.model.scenes.filter((scene) => pictures_of(page.model, scene.id).all.length);
    const host = document.getElementById("viewer");
    if (!scenes.length) return host.replaceChildren(h("p", {class: "empty"}, "This sweep kept no pictures."));
    a = new Picker("A", changed);
    b = new Picker("B", changed);
    build(host, scenes);
    view = new CanvasView(parts.canvas, {
      on_cursor: (pixel) => {
        cursor = pixel;
        read_out();
      },
      on_move: read_out,
    });
    on_resize(parts.stage, layout);
    show_scene(scenes[0].id);
  }

  function build(host, scenes) {
    const set = (key, redraw) => (value) => {
      state[key] = value;
      redraw();
    };
    parts.mode = segments("Mode", kModes, state.mode, set_mode);
    parts.shows = segments("Show", [{value: "picture", label: "Picture"}, {value: "error", label: "Error map", title: "E"}], state.shows, set("shows", changed));
    parts.scene = h("select", {class: "scene", "aria-label": "Scene of the pictures", onchange: () => show_scene(parts.scene.value)},
                    scenes.map((scene) => h("option", {value: scene.id}, scene.name)));
    parts.stops = h("input", {type: "range", min: -8, max: 8, step: 0.25, value: 0, "aria-label": "Exposure in stops", oninput: () => set_stops(Number(parts.stops.value))});
    parts.stops_text = h("output");
    parts.scale = h("select", {"aria-label": "Upper end of the error scale", onchange: () => {
      state.scale = Number(parts.scale.value) || null;
      changed();
    }}, h("option", {value: ""}, "scale: 99 % of pixels"), [0.05, 0.1, 0.2, 0.5, 1, 2, 5].map((v) => h("option", {value: v}, `scale: 0 to ${v}`)));
    parts.canvas = h("canvas", {tabindex: 0, role: "img", "aria-label": "Picture", "aria-describedby": "viewer-keys"});
    parts.labels = [0, 1].map(() => h("span", {class: "label"}));
    parts.legend = h("div", {class: "scale", "aria-hidden": "true"});
    parts.stage = h("div", {class: "stage"}, parts.canvas, parts.labels);
    parts.read = h("output", {class: "readout"});
    parts.frame = h("figure", {class: "viewer", onkeydown: on_key},
      h("div", {class: "bar"}, parts.mode, parts.shows,
        h("label", {class: "exposure"}, "Exposure ", parts.stops, parts.stops_text), parts.scale,
        h("span", {class: "segments"}, button("−", "Zoom out", () => view.zoom_to(view.scale() / 2)), button("+", "Zoom in", () => view.zoom_to(view.scale() * 2)),
          button("1:1", "A pixel of the picture on one of the screen", () => view.zoom_to(1 / window.devicePixelRatio)),
          button("Fit", "Whole picture (R)", () => view.moved(() => view.fit()))),
        button("Full screen", "", () => (document.fullscreenElement ? document.exitFullscreen() : parts.frame.requestFullscreen()))),
      h("div", {class: "bar"}, scenes.length > 1 ? parts.scene : null, a.element, button("⇄", "Exchange A and B (X)", exchange, "exchange"), b.element),
      h("div", {class: "stage-row"}, parts.stage, parts.legend), parts.read,
      h("details", {id: "viewer-keys", class: "note"}, h("summary", {}, "Keys and pointer"), h("div", {class: "keys"}, kHelp.map(([keys, what]) => h("div", {}, h("kbd", {}, keys), ` ${what}`)))));
    host.replaceChildren(parts.frame);
    set_stops(0);
  }

  const kHelp = [["F, space", "flip between A and B"], ["1 … 9", "a method on side A (again: its next parameters); with Shift on side B"],
                 ["0", "the reference on side A; with Shift on side B"], ["X", "exchange A and B"], ["E", "picture or error map"],
                 ["+ −", "exposure, half a stop"], ["wheel, pinch, double click", "zoom in, out, whole picture"], ["R", "whole picture"],
                 ["arrows", "move; with Shift the bar of the split"], ["M", "next mode"]];

  const button = (label, title, onclick, name = null) =>
    h("button", {type: "button", class: name, title, "aria-label": title || null, onclick}, label);

  function show_scene(scene) {
    if (state.scene === scene) return;
    const before = [a.choice, b.choice];
    state.scene = scene;
    parts.scene.value = scene;
    const choices = pictures_of(page.model, scene);
    // The same method and parameters as in the scene before, where it has them.
    const like = (choice) => choices.all.find((c) => choice && c.name === choice.name);
    [a, b].forEach((picker) => picker.fill(choices));
    a.choose(like(before[0]) ?? choices.all[0]);
    b.choose(like(before[1]) ?? choices.references[0] ?? choices.all.at(-1));
  }

  /// From elsewhere on the page: `cell` on side A, beside its reference; `item` is what was asked for where it has none.
  function show(cell, item = cell) {
    if (!view) return;
    show_scene(item.scene);
    document.getElementById("images").scrollIntoView({block: "start", behavior: "auto"});
    parts.canvas.focus({preventScroll: true});
    if (!cell) return void state.loaded.then(() => say(`${item.name}: no picture was kept`));
    const choice = a.choices.all.find((c) => c.pictures.some((p) => p.cell === cell));
    state.flipped = false;
    a.choose(choice, cell.seed);
    const truth = b.choices.references.find((c) => c.pictures[0].file === a.picture.truth);
    if (truth) b.choose(truth);
  }

  function say(message) {
    parts.read.textContent = message;
  }

  function exchange() {
    const [choice, seed] = [a.choice, a.picture.seed];
    a.choose(b.choice, b.picture.seed);
    b.choose(choice, seed);
  }

  function set_mode(mode) {
    state.mode = mode;
    parts.mode.choose(mode);
    state.flipped = false;
    layout();
    changed();
  }

  function set_stops(stops) {
    state.stops = Math.min(8, Math.max(-8, stops));
    parts.stops.value = state.stops;
    parts.stops_text.textContent = `${state.stops > 0 ? "+" : ""}${state.stops.toFixed(2).replace("-", "−")} stops`;
    changed();
  }

  function flip() {
    if (state.mode !== "flip") set_mode("flip");
    state.flipped = !state.flipped;
    changed();
  }

  function on_key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target, on_canvas = target === parts.canvas;
    // Selects and sliders keep the keys that are theirs.
    if (!on_canvas && (target.tagName === "SELECT" || event.key === " " || event.key.startsWith("Arrow"))) return;
    const digit = /^Digit(\d)$|^Numpad(\d)$/.exec(event.code);
    const arrows = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    const actions = {
      f: flip, " ": flip, x: exchange, r: () => view.moved(() => view.fit()),
      e: () => parts.shows.querySelector(`[data-value=${state.shows === "error" ? "picture" : "error"}]`).click(),
      m: () => set_mode(kModes[(kModes.findIndex((m) => m.value === state.mode) + 1) % kModes.length].value),
      "+": () => set_stops(state.stops + 0.5), "=": () => set_stops(state.stops + 0.5), "-": () => set_stops(state.stops - 0.5),
    };
    const action = actions[event.key.toLowerCase()];
    if (action) action();
    else if (digit) (event.shiftKey ? b : a).choose_number(Number(digit[1] ?? digit[2]));
    else if (arrows && event.shiftKey && state.mode === "split") view.split_to(view.split - arrows[0] * 0.02);
    else if (arrows && view.zoom !== null) view.pan(arrows[0] * 48, arrows[1] * 48);
    else return;
    event.preventDefault();
  }

  /// Which sides are on the canvas: 0 for A, 1 for B.
  const sides = () => ({single: [0], flip: [state.flipped ? 1 : 0]}[state.mode] ?? [0, 1]);

  /// Gives the canvas the shape its pictures need.
  function layout() {
    if (!view) return;
    const {size} = view, width = parts.stage.clientWidth;
    const shape = size ? size.height / size.width : 9 / 16;
    const halves = state.mode !== "side" ? 1 : width < CanvasView.kNarrow ? 2 : 0.5;
    const most = document.fullscreenElement ? window.innerHeight - 190 : window.innerHeight * 0.74 * Math.max(1, halves);
    parts.canvas.style.height = `${Math.round(Math.min(width * shape * halves, most))}px`;
    view.redraw();
  }

  const changed = () => void (state.loaded = load_and_render());

  /// Loads what is to be seen and then shows it; what was asked for later wins.
  async function load_and_render() {
    if (!view || !a.picture || !b.picture) return;
    const wanted = sides().map((side) => [a, b][side].picture);
    const files = wanted.flatMap((picture) => (state.shows === "error" ? [picture.file, picture.truth] : [picture.file])).filter(Boolean);
    state.ticket = (state.ticket ?? 0) + 1;
    const ticket = state.ticket;
    const late = setTimeout(() => ticket === state.ticket && label("loading …"), 150);
    const results = await Promise.allSettled(files.map((file) => Images.load(file)));
    clearTimeout(late);
    if (ticket !== state.ticket) return;
    state.problem = results.find((r) => r.status === "rejected")?.reason.message ?? "";
    render();
  }

  function render() {
    const shown = sides(), pickers = [a, b];
    const automatic = () => Math.max(0, ...shown.map((side) => error_of(pickers[side].picture)?.high ?? 0)) || 1;
    const high = state.shows === "error" ? state.scale ?? automatic() : null;
    const layers = shown.map((side) => {
      const {picture} = pickers[side], image = Images.ready(picture.file), error = high && error_of(picture);
      return {picture: paint(side, picture, image, error, high), numbers: (x, y) => numbers(image, error, x, y)};
    });
    const image = shown.map((side) => Images.ready(pickers[side].picture.file)).find(Boolean);
    const other_shape = image && (view.size?.width !== image.width || view.size?.height !== image.height);
    view.show(state.mode === "side" || state.mode === "split" ? state.mode : "one", layers, image && {width: image.width, height: image.height});
    if (other_shape) layout();
    parts.legend.hidden = high === null;
    parts.scale.hidden = high === null;
    if (high !== null) draw_scale(high);
    label();
    read_out();
  }

  function paint(side, picture, image, error, high) {
    if (!image || (high && !error)) return null;
    const exposure = (page.model.scene.get(state.scene)?.exposure ?? image.exposure) * 2 ** state.stops;
    const key = high ? `${picture.file} ${high}` : `${picture.file} at ${exposure}`;
    if (toned[side]?.key !== key)
      toned[side] = {key, picture: high ? Tone.error_map(image, error.error, high) : Tone.picture(image, exposure)};
    return toned[side].picture;
  }

  /// The relative error of a picture against what it is scored against, or null while either is not there.
  function error_of({file, truth}) {
    const image = Images.ready(file), reference = truth && Images.ready(truth);
    if (!image || !reference || image.packed.length !== reference.packed.length) return null;
    const key = `${file}|${truth}`;
    if (!maps.has(key)) maps.set(key, Tone.relative_error(image, reference));
    if (maps.size > 4) maps.delete(maps.keys().next().value);
    return maps.get(key);
  }

  function numbers(image, error, x, y) {
    const i = y * image.width + x, rgb = [0, 0, 0];
    if (error) return [Format.number(error.error[i])];
    Images.unpack(image.packed, i, rgb);
    return image.nan.has(i) ? ["NaN"] : rgb.map((v) => Format.number(v));
  }

  function draw_scale(high) {
    const bar = h("i");
    bar.style.background = Tone.gradient("to top");
    parts.legend.replaceChildren(h("span", {}, `≥ ${high}`), bar, h("span", {}, "0"));
    parts.legend.title = "Relative error: root of the mean over channels of (x−r)² / (r² + (0.1 mean r)²)";
  }

  function label(text = null) {
    const shown = sides(), split = state.mode === "split" || state.mode === "side";
    const stacked = state.mode === "side" && parts.stage.clientWidth < CanvasView.kNarrow;
    parts.labels.forEach((element, i) => {
      const side = shown[i], picker = [a, b][side];
      element.hidden = side === undefined;
      if (!picker) return;
      element.className = `label ${i === 0 ? "left" : stacked ? "lower" : state.mode === "side" ? "half" : "right"}`;
      element.textContent = text ?? `${split || state.mode === "flip" ? `${"AB"[side]}: ` : ""}${picker.title()}`;
    });
    parts.canvas.setAttribute("aria-label", `${shown.map((side) => [a, b][side].picture.name).join(" and ")}, ${state.shows}`);
  }

  /// The values under the pointer, of both sides, or what went wrong.
  function read_out() {
    if (state.problem) return say(state.problem);
    if (!cursor || !view.size) return say(`${view.size ? `${view.size.width} × ${view.size.height}, ` : ""}zoom ${Format.number(view.scale())} : 1. Point at a pixel to read it.`);
    const rgb = [0, 0, 0];
    const values = [a, b].map(({picture}, side) => {
      const image = Images.ready(picture.file), i = image && cursor.y * image.width + cursor.x;
      if (!image || i >= image.packed.length) return null;
      Images.unpack(image.packed, i, rgb);
      const error = state.shows === "error" && error_of(picture);
      return `${"AB"[side]} ${rgb.map((v) => Format.number(v)).join(" ")}${error ? ` (error ${Format.number(error.error[i])})` : ""}`;
    });
    say(`x ${cursor.x}, y ${cursor.y}   linear RGB   ${values.filter(Boolean).join("   ")}`);
  }

  return {set_up, show, show_scene: (scene) => view && show_scene(scene)};
})();
