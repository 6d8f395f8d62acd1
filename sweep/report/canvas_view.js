"use strict";
// A canvas that shows one or two pictures of one size and lets the reader move about in them: wheel, drag, pinch. Both
// pictures share centre and zoom, so what is under the pointer in one is under it in the other.

class CanvasView {
  static kMostZoom = 96; // CSS px a pixel
  static kNumbersFrom = 52; // CSS px a pixel from which its values are written into it
  static kNarrow = 620; // CSS px: side by side stands one above the other below this width

  /// on_cursor({x, y} or null): the pixel under the pointer; on_move(): zoom, centre or split have changed.
  constructor(canvas, {on_cursor, on_move}) {
    Object.assign(this, {canvas, on_cursor, on_move, layout: "one", layers: [], size: null, zoom: null, split: 0.5});
    this.center = {x: 0, y: 0}; // of the view, in pixels of the picture
    this.pointers = new Map();
    this.listen();
  }

  /// layout: "one" (a layer over the whole canvas), "split" (two, left and right of the bar) or "side".
  /// layers: [{picture: canvas or null, numbers(x, y): [r, g, b]}]; size: {width, height} of every picture.
  show(layout, layers, size) {
    const other_size = size && (!this.size || size.width !== this.size.width || size.height !== this.size.height);
    Object.assign(this, {layout, layers, size: size ?? this.size});
    if (other_size) this.fit();
    this.redraw();
  }

  /// Whole picture. `zoom` null means just that, whatever the canvas's size.
  fit() {
    this.zoom = null;
    if (this.size) this.center = {x: this.size.width / 2, y: this.size.height / 2};
    this.redraw();
  }

  panes() {
    const width = this.canvas.clientWidth,
      height = this.canvas.clientHeight;
    if (this.layout !== "side") return [{left: 0, top: 0, width, height}];
    if (width < CanvasView.kNarrow)
      return [0, 1].map((i) => ({left: 0, top: (i * (height + 4)) / 2, width, height: (height - 4) / 2}));
    return [0, 1].map((i) => ({left: (i * (width + 4)) / 2, top: 0, width: (width - 4) / 2, height}));
  }

  fit_zoom() {
    const [pane] = this.panes();
    return this.size ? Math.min(pane.width / this.size.width, pane.height / this.size.height) : 1;
  }

  scale() {
    return this.zoom ?? this.fit_zoom();
  }

  /// Sets the zoom so that what lies at (`x`, `y`) of the canvas, by default the middle, stays there.
  zoom_to(zoom, x, y) {
    if (!this.size) return;
    const least = this.fit_zoom();
    const clamped = Math.min(zoom, Math.max(least, CanvasView.kMostZoom));
    if (clamped <= least * 1.0001) return this.moved(() => this.fit());
    const pane = this.pane_at(x, y) ?? this.panes()[0];
    const dx = (x ?? pane.left + pane.width / 2) - pane.left - pane.width / 2;
    const dy = (y ?? pane.top + pane.height / 2) - pane.top - pane.height / 2;
    const before = this.scale();
    this.moved(() => {
      this.center.x += dx / before - dx / clamped;
      this.center.y += dy / before - dy / clamped;
      this.zoom = clamped;
    });
  }

  pan(dx, dy) {
    if (this.zoom === null) return;
    this.moved(() => {
      this.center.x -= dx / this.zoom;
      this.center.y -= dy / this.zoom;
    });
  }

  moved(change) {
    change();
    if (this.size) {
      this.center.x = Math.min(Math.max(this.center.x, 0), this.size.width);
      this.center.y = Math.min(Math.max(this.center.y, 0), this.size.height);
    }
    // At rest one finger scrolls the page; zoomed in, it moves the picture.
    this.canvas.style.touchAction = this.zoom === null ? "pan-y" : "none";
    this.redraw();
    this.on_move();
  }

  pane_at(x, y) {
    return this.panes().find((p) => x >= p.left && x < p.left + p.width && y >= p.top && y < p.top + p.height);
  }

  /// The picture's pixel at a place of the canvas, or null beside it.
  pixel_at(x, y) {
    const pane = this.pane_at(x, y);
    if (!pane || !this.size) return null;
    const px = Math.floor(this.center.x + (x - pane.left - pane.width / 2) / this.scale());
    const py = Math.floor(this.center.y + (y - pane.top - pane.height / 2) / this.scale());
    return px >= 0 && py >= 0 && px < this.size.width && py < this.size.height ? {x: px, y: py} : null;
  }

  listen() {
    const {canvas} = this;
    const place = (event) => ({x: event.offsetX, y: event.offsetY});
    let last_scroll = 0; // a page being scrolled past the canvas goes on scrolling
    window.addEventListener(
      "wheel",
      (event) => {
        if (event.target !== canvas) last_scroll = event.timeStamp;
      },
      {passive: true},
    );
    canvas.addEventListener(
      "wheel",
      (event) => {
        if (event.timeStamp - last_scroll < 250 && !event.ctrlKey) return void (last_scroll = event.timeStamp);
        if (event.deltaY > 0 && this.zoom === null && !event.ctrlKey) return;
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode === 1 ? 33 : 1);
        this.zoom_to(this.scale() * 2 ** (-pixels / 200), event.offsetX, event.offsetY);
      },
      {passive: false},
    );
    canvas.addEventListener("dblclick", () => this.moved(() => this.fit()));

    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      const reach = event.pointerType === "touch" ? 24 : 8;
      this.dragging_split =
        this.layout === "split" && Math.abs(event.offsetX - this.split * canvas.clientWidth) < reach;
      this.pointers.set(event.pointerId, place(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      this.drag(event.pointerId, place(event));
      const bar = this.layout === "split" && Math.abs(event.offsetX - this.split * canvas.clientWidth) < 8;
      canvas.style.cursor = bar ? "col-resize" : this.pointers.size ? "grabbing" : "crosshair";
      this.on_cursor(this.pixel_at(event.offsetX, event.offsetY));
    });
    const release = (event) => this.pointers.delete(event.pointerId);
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("pointerleave", () => this.on_cursor(null));
  }

  drag(id, now) {
    const before = this.pointers.get(id);
    if (!before) return;
    const other = [...this.pointers].find(([key]) => key !== id)?.[1];
    this.pointers.set(id, now);
    if (this.dragging_split) return this.split_to(now.x / this.canvas.clientWidth);
    if (!other) return this.pan(now.x - before.x, now.y - before.y);
    const apart = (p) => Math.hypot(p.x - other.x, p.y - other.y) || 1;
    this.zoom_to((this.scale() * apart(now)) / apart(before), (now.x + other.x) / 2, (now.y + other.y) / 2);
  }

  split_to(share) {
    this.moved(() => (this.split = Math.min(1, Math.max(0, share))));
  }

  redraw() {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.draw();
    });
  }

  draw() {
    const {canvas} = this,
      dots = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * dots),
      height = Math.round(canvas.clientHeight * dots);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const context = canvas.getContext("2d");
    context.setTransform(dots, 0, 0, dots, 0, 0);
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    const panes = this.panes(),
      bar = this.split * canvas.clientWidth;
    this.layers.forEach((layer, i) => {
      const pane = panes[Math.min(i, panes.length - 1)];
      const clip =
        this.layout !== "split"
          ? pane
          : i === 0
            ? {...pane, width: bar}
            : {...pane, left: bar, width: pane.width - bar};
      if (layer?.picture) this.draw_layer(context, layer, pane, clip);
    });
    if (this.layout === "split") this.draw_bar(context, bar);
  }

  draw_layer(context, layer, pane, clip) {
    const scale = this.scale(),
      {width, height} = this.size;
    const left = pane.left + pane.width / 2 - this.center.x * scale,
      top = pane.top + pane.height / 2 - this.center.y * scale;
    context.save();
    context.beginPath();
    context.rect(clip.left, clip.top, clip.width, clip.height);
    context.clip();
    // Pixels stay squares when enlarged; when reduced, they are averaged.
    context.imageSmoothingEnabled = scale * (window.devicePixelRatio || 1) < 1;
    context.imageSmoothingQuality = "high";
    context.drawImage(layer.picture, left, top, width * scale, height * scale);
    if (scale >= CanvasView.kNumbersFrom) this.draw_numbers(context, layer, left, top, clip);
    context.restore();
  }

  /// Each visible pixel's values, in dark letters with a bright rim: legible on any colour.
  draw_numbers(context, layer, left, top, clip) {
    const scale = this.scale(),
      line = scale / 5;
    context.font = `${Math.min(13, scale / 5.2)}px ui-monospace, monospace`;
    context.textAlign = "center";
    context.lineWidth = 2.5;
    context.strokeStyle = "rgba(255, 255, 255, 0.85)";
    context.fillStyle = "#000";
    const first = (edge, start) => Math.max(0, Math.floor((edge - start) / scale));
    for (let y = first(clip.top, top); y < Math.min(this.size.height, (clip.top + clip.height - top) / scale); ++y) {
      for (
        let x = first(clip.left, left);
        x < Math.min(this.size.width, (clip.left + clip.width - left) / scale);
        ++x
      ) {
        layer.numbers(x, y).forEach((text, i, all) => {
          const at = [left + (x + 0.5) * scale, top + (y + 0.5) * scale + (i - (all.length - 1) / 2 + 0.3) * line];
          context.strokeText(text, ...at);
          context.fillText(text, ...at);
        });
      }
    }
  }

  draw_bar(context, x) {
    const height = this.canvas.clientHeight;
    context.fillStyle = "rgba(0, 0, 0, 0.55)";
    context.fillRect(x - 2, 0, 4, height);
    context.fillStyle = "#fff";
    context.fillRect(x - 1, 0, 2, height);
    context.beginPath();
    context.arc(x, height / 2, 9, 0, 7);
    context.fill();
    context.fillStyle = "#222";
    for (const side of [-1, 1]) {
      context.beginPath();
      context.moveTo(x + side * 6, height / 2);
      context.lineTo(x + side * 2, height / 2 - 4);
      context.lineTo(x + side * 2, height / 2 + 4);
      context.fill();
    }
  }
}
