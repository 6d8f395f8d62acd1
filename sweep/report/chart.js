"use strict";
// The charts of error against time: what of the results goes into them, their legend and what a point answers.

const Chart = (() => {
  let view = "final"; // or "over_time"

  function set_up(page) {
    const has_curves = page.model.cells.some((cell) => (cell.curve ?? []).length > 1);
    const views = [
      {value: "final", label: "Final error"},
      {value: "over_time", label: "Error over time", title: "How each run converged"},
    ];
    const controls = segments("View", views, view, (chosen) => {
      view = chosen;
      draw(page);
    });
    if (has_curves && window.ZonalCharts) document.getElementById("chart-controls").append(controls);

    document
      .getElementById("legend")
      .replaceChildren(
        ...(window.ZonalCharts
          ? page.model.methods.map((method) =>
              h(
                "button",
                {
                  type: "button",
                  title: "With Shift: this one alone",
                  "aria-pressed": "true",
                  "data-method": method.id,
                  onclick: (event) => toggle(page, method, event),
                },
                Methods.name(method),
              ),
            )
          : []),
      );
    on_resize(document.getElementById("panels"), () => draw(page));
  }

  /// A press hides or shows a method; with Alt or Shift it leaves that method alone, or brings all back.
  function toggle(page, method, event) {
    const {hidden, model} = page;
    if (event.altKey || event.shiftKey) {
      const alone = hidden.size === model.methods.length - 1 && !hidden.has(method.id);
      hidden.clear();
      if (!alone) model.methods.filter((m) => m !== method).forEach((m) => hidden.add(m.id));
    } else if (!hidden.delete(method.id)) {
      hidden.add(method.id);
    }
    for (const button of document.querySelectorAll("#legend button"))
      button.setAttribute("aria-pressed", String(!hidden.has(button.dataset.method)));
    page.redraw();
  }

  function draw(page) {
    const panels = document.getElementById("panels"),
      note = document.getElementById("chart-note");
    Tooltip.hide();
    if (!window.ZonalCharts) {
      panels.replaceChildren(
        ...page
          .scenes()
          .map((scene) =>
            h(
              "figure",
              {},
              h("figcaption", {}, scene.name),
              h("img", {
                src: scene.chart ?? `charts/${scene.id}.svg`,
                alt: `Error against time in ${scene.name}, a point for each group of seeds`,
              }),
            ),
          ),
      );
      note.textContent = "This report was made by a build without Node, so its charts are pictures.";
      return;
    }
    panels.replaceChildren(
      ...page.scenes().map((scene) => {
        const figure = h("figure", {"data-scene": scene.id}, h("figcaption", {}, scene.name));
        return figure;
      }),
    );
    let missing = 0;
    for (const figure of panels.children) {
      const width = Math.max(280, figure.clientWidth);
      const spec = {
        ...common(page, figure.dataset.scene),
        width,
        height: Math.round(Math.min(Math.max(0.66 * width, 300), 560)),
      };
      const drawn =
        view === "final"
          ? final_error(page, figure.dataset.scene, spec)
          : convergence(page, figure.dataset.scene, spec);
      missing += drawn.missing;
      figure.append(drawn.empty ? h("p", {class: "empty"}, "Nothing to draw: no time or score.") : drawn.svg);
    }
    const left_out = `${Format.count(missing, "group")} without a time or a score: in the table only.`;
    note.textContent = missing ? `${kNotes[view]} ${left_out}` : kNotes[view];
  }

  const kNotes = {
    final:
      "Lower left is better. A point is the mean over seeds, its bars the 95 % intervals of that mean; the grey band "
      + "is the front: nothing shown is both faster and better. Hollow points are limited by their reference, whose "
      + "own error is the dotted line. Times hold begin_pass and radiance alone. Click a point to see its picture.",
    over_time:
      "Thin lines are seeds, strong ones their mean, measured outside the clock at 1, 2, 4, … passes; a group that "
      + "was scored at its end alone is a point. Click a point to see the last picture.",
  };

  /// Floors whose words would lie on top of each other share a line.
  function apart(floors) {
    const lines = [];
    for (const floor of floors.sort((a, b) => a.value - b.value)) {
      const last = lines.at(-1);
      if (last && floor.value < 1.2 * last.value) last.label += `; ${floor.label.replace("reference: ", "")}`;
      else lines.push(floor);
    }
    return lines;
  }

  /// What both charts of a scene share.
  function common(page, scene) {
    const axis = Metrics.axis(page.metric),
      key = Metrics.key(page.metric);
    const references = Model.references_of(page.model, scene);
    const floors = apart(
      references
        .map((r) => ({
          value: axis.value(r.floor?.[key]),
          label: references.length > 1 ? `reference: ${r.transport}` : "reference's own error",
        }))
        .filter((floor) => floor.value !== null && floor.value > 0),
    );
    return {
      x_label: "time (s)",
      y_label: axis.label,
      y_kind: axis.kind,
      y_reverse: axis.reverse,
      floors,
      on_hover: (point, at) => (point ? Tooltip.show(point.name, rows_of(page, point), at) : Tooltip.hide()),
      on_pick: (point) => page.show_image(Model.picture_of(point.group), point.group),
    };
  }

  const shown_groups = (page, scene) =>
    page.model.groups.filter((g) => g.scene === scene && !page.hidden.has(g.method));

  const style = (page, group) => {
    const method = page.model.method.get(group.method);
    // Where backends meet in one chart, the second one's lines are dashed.
    return {
      color: Methods.color(method),
      shape: Methods.shape(method),
      dashed: page.model.backends.indexOf(group.backend) > 0,
    };
  };

  function final_error(page, scene, spec) {
    const axis = Metrics.axis(page.metric),
      key = Metrics.key(page.metric);
    const groups = shown_groups(page, scene);
    const points = groups
      .map((group) => {
        const score = group.scores?.[key];
        const [y_low, y_high] = Metrics.bounds(axis, score);
        return {
          x: group.time?.mean ?? null,
          x_low: group.time?.low ?? null,
          x_high: group.time?.high ?? null,
          y: axis.value(score?.mean),
          y_low,
          y_high,
          ...style(page, group),
          hollow: group.reference_limited,
          line: group.line.id,
          place: group.line.place,
          name: group.name,
          group,
        };
      })
      .filter((p) => p.x > 0 && p.y !== null)
      .sort((a, b) => a.place - b.place);
    const missing = groups.length - points.length;
    if (!points.length) return {empty: true, missing};
    return {svg: ZonalCharts.pareto({...spec, points, front: front_of(points, axis.better)}), missing};
  }

  /// Points that none beats in both time and error, by rising time.
  function front_of(points, better) {
    const front = [];
    for (const p of [...points].sort((a, b) => a.x - b.x || (better(a.y, b.y) ? -1 : 1)))
      if (!front.length || better(p.y, front.at(-1).y)) front.push(p);
    return front;
  }

  function convergence(page, scene, spec) {
    const axis = Metrics.axis(page.metric),
      key = Metrics.key(page.metric);
    const groups = shown_groups(page, scene);
    const curves = groups.flatMap((group) => {
      const curve = (points, mean) => ({
        ...style(page, group),
        group,
        mean,
        points: points.filter((p) => p.x > 0 && p.y !== null),
      });
      const point = (passes, seconds, score) => ({
        x: seconds,
        y: axis.value(score),
        name: group.name,
        passes,
        score,
        group,
      });
      const mean = Model.mean_curve(group, key);
      if (!mean.length) return [curve([point(null, group.time?.mean, group.scores?.[key]?.mean)], true)];
      return [
        ...group.done.map((cell) =>
          curve(
            (cell.curve ?? []).map((p) => point(p.passes, p.seconds, p.scores?.[key])),
            false,
          ),
        ),
        curve(
          mean.map((p) => point(p.passes, p.seconds, p.score)),
          true,
        ),
      ];
    });
    const drawn = new Set(curves.filter((c) => c.points.length).map((c) => c.group));
    if (!drawn.size) return {empty: true, missing: groups.length};
    return {svg: ZonalCharts.over_time({...spec, curves}), missing: groups.length - drawn.size};
  }

  /// What the tooltip says of a point of either view.
  function rows_of(page, point) {
    const {group} = point,
      heading = Metrics.heading(page.metric);
    if (point.passes)
      return [
        ["passes", String(point.passes)],
        ["time", Format.duration(point.x)],
        [heading, Format.number(point.score)],
      ];
    const score = group.scores[Metrics.key(page.metric)] ?? {};
    const rows = [
      ["time", `${Format.number(group.time.mean)} s ${Format.interval(group.time).replace("–", "")}`],
      [heading, `${Format.number(score.mean)} ${Format.interval(score).replace("–", "")}`],
      ["worst seed", `${Format.number(score.worst)}, of ${score.seeds ?? group.done.length}`],
      ["noise, bias (RMSE)", `${Format.number(group.noise)}, ${Format.number(group.bias)}`],
    ];
    if (group.failed) rows.push(["failed", `${group.failed} of ${group.members.length}`]);
    if (group.not_reached) rows.push(["budget", "not reached"]);
    if (group.reference_limited) rows.push(["limit", "the reference's own error"]);
    return rows;
  }

  return {draw, set_up};
})();
