"use strict";
// The image viewer: two pictures, A and B, of one scene, shown alone, in turn, split or side by side, as they look or
// as maps of their relative error.

const Viewer = (() => {
  const kModes = [
    {value: "single", label: "Single"},
    {value: "flip", label: "Flip", title: "F or space changes sides"},
    {value: "split", label: "Split", title: "Drag the bar"},
    {value: "side", label: "Side by side"},
  ];
  const state = {
    scene: null,
    mode: "split",
    shows: "picture",
    stops: 0,
    flipped: false,
    scale: null,
    loaded: Promise.resolve(),
  };
  const parts = {}; // the elements, of viewer_parts.js
  const maps = new Map(); // "file of picture|file of truth" -> relative error; the last four
  const toned = [null, null]; // what each side was last painted from: {key, picture}
  let page,
    view,
    a,
    b,
    cursor = null;

  function set_up(its_page) {
    page = its_page;
    const scenes = page.model.scenes.filter((scene) => pictures_of(page.model, scene.id).all.length);
    const host = document.getElementById("viewer");
    if (!scenes.length) return host.replaceChildren(h("p", {class: "empty"}, "This sweep kept no pictures."));
    a = new Picker("A", changed);
    b = new Picker("B", changed);
    Object.assign(parts, viewer_parts({scenes, modes: kModes, state, pickers: [a, b], actions}));
    host.replaceChildren(parts.frame);
    set_stops(0);
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

  function set_shows(shows) {
    state.shows = shows;
    parts.shows.choose(shows);
    changed();
  }

  /// `high`: the upper end of the error scale; null for one that follows the pictures.
  function set_scale(high) {
    state.scale = high;
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

  /// What keys and buttons do.
  const actions = {
    flip,
    exchange,
    choose: (n, on_b) => (on_b ? b : a).choose_number(n),
    error_map: () => set_shows(state.shows === "error" ? "picture" : "error"),
    exposure: (by) => set_stops(state.stops + by),
    fit: () => view.moved(() => view.fit()),
    next_mode: () => set_mode(kModes[(kModes.findIndex((m) => m.value === state.mode) + 1) % kModes.length].value),
    pan: (dx, dy) => view.zoom !== null && view.pan(dx, dy),
    move_bar: (by) => state.mode === "split" && view.split_to(view.split + by),
    zoom: (factor) => view.zoom_to(view.scale() * factor),
    one_to_one: () => view.zoom_to(1 / window.devicePixelRatio),
    full_screen: () => (document.fullscreenElement ? document.exitFullscreen() : parts.frame.requestFullscreen()),
    set_mode,
    set_scale,
    set_shows,
    set_stops,
    show_scene,
  };

  /// Which sides are on the canvas: 0 for A, 1 for B.
  const sides = () => ({single: [0], flip: [state.flipped ? 1 : 0]})[state.mode] ?? [0, 1];

  /// Gives the canvas the shape its pictures need.
  function layout() {
    if (!view) return;
    const {size} = view,
      width = parts.stage.clientWidth;
    const shape = size ? size.height / size.width : 9 / 16;
    const halves = state.mode !== "side" ? 1 : width < CanvasView.kNarrow ? 2 : 0.5;
    const most = document.fullscreenElement
      ? window.innerHeight - 190
      : window.innerHeight * 0.74 * Math.max(1, halves);
    parts.canvas.style.height = `${Math.round(Math.min(width * shape * halves, most))}px`;
    view.redraw();
  }

  const changed = () => void (state.loaded = load_and_render());

  /// Loads what is to be seen and then shows it; what was asked for later wins.
  async function load_and_render() {
    if (!view || !a.picture || !b.picture) return;
    const wanted = sides().map((side) => [a, b][side].picture);
    const files = wanted
      .flatMap((picture) => (state.shows === "error" ? [picture.file, picture.truth] : [picture.file]))
      .filter(Boolean);
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
    const shown = sides(),
      pickers = [a, b];
    const automatic = () => Math.max(0, ...shown.map((side) => error_of(pickers[side].picture)?.high ?? 0)) || 1;
    const high = state.shows === "error" ? (state.scale ?? automatic()) : null;
    const layers = shown.map((side) => {
      const {picture} = pickers[side],
        image = Images.ready(picture.file),
        error = high && error_of(picture);
      return {picture: paint(side, picture, image, error, high), numbers: (x, y) => numbers(image, error, x, y)};
    });
    const image = shown.map((side) => Images.ready(pickers[side].picture.file)).find(Boolean);
    const other_shape = image && (view.size?.width !== image.width || view.size?.height !== image.height);
    view.show(
      state.mode === "side" || state.mode === "split" ? state.mode : "one",
      layers,
      image && {width: image.width, height: image.height},
    );
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
    const image = Images.ready(file),
      reference = truth && Images.ready(truth);
    if (!image || !reference || image.packed.length !== reference.packed.length) return null;
    const key = `${file}|${truth}`;
    if (!maps.has(key)) maps.set(key, Tone.relative_error(image, reference));
    if (maps.size > 4) maps.delete(maps.keys().next().value);
    return maps.get(key);
  }

  function numbers(image, error, x, y) {
    const i = y * image.width + x,
      rgb = [0, 0, 0];
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
    const shown = sides(),
      split = state.mode === "split" || state.mode === "side";
    const stacked = state.mode === "side" && parts.stage.clientWidth < CanvasView.kNarrow;
    parts.labels.forEach((element, i) => {
      const side = shown[i],
        picker = [a, b][side];
      element.hidden = side === undefined;
      if (!picker) return;
      element.className = `label ${i === 0 ? "left" : stacked ? "lower" : state.mode === "side" ? "half" : "right"}`;
      element.textContent = text ?? `${split || state.mode === "flip" ? `${"AB"[side]}: ` : ""}${picker.title()}`;
    });
    parts.canvas.setAttribute(
      "aria-label",
      `${shown.map((side) => [a, b][side].picture.name).join(" and ")}, ${state.shows}`,
    );
  }

  /// The values under the pointer, of both sides, or what went wrong.
  function read_out() {
    if (state.problem) return say(state.problem);
    if (!view.size) return say("");
    const {width, height} = view.size;
    if (!cursor)
      return say(`${width} × ${height}, zoom ${Format.number(view.scale())} : 1. Point at a pixel to read it.`);
    const rgb = [0, 0, 0];
    const values = [a, b].map(({picture}, side) => {
      const image = Images.ready(picture.file),
        i = image && cursor.y * image.width + cursor.x;
      if (!image || i >= image.packed.length) return null;
      Images.unpack(image.packed, i, rgb);
      const error = state.shows === "error" && error_of(picture);
      const value = `${"AB"[side]} ${rgb.map((v) => Format.number(v)).join(" ")}`;
      return error ? `${value} (error ${Format.number(error.error[i])})` : value;
    });
    say(`x ${cursor.x}, y ${cursor.y}   linear RGB   ${values.filter(Boolean).join("   ")}`);
  }

  return {set_up, show, show_scene: (scene) => view && show_scene(scene)};
})();
