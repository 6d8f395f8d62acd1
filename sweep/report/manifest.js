"use strict";
// All that is needed to make the numbers again, or to doubt them: machine, program, sweep file, references, formulas,
// and how steady the machine was.

const Manifest = (() => {
  function set_up(page) {
    const {model} = page;
    document
      .getElementById("made")
      .replaceChildren(
        facts(model),
        references(page),
        formulas(model),
        drift(model),
        model.sweep?.text ? fold("Sweep file", h("pre", {tabindex: "0"}, model.sweep.text)) : "",
      );
  }

  const list = (pairs) =>
    h(
      "dl",
      {class: "facts"},
      pairs.filter(([, value]) => value).map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))),
    );
  const fold = (title, ...content) => h("details", {}, h("summary", {}, title), ...content);
  const heads = (names) =>
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        names.map((name) => h("th", {scope: "col", class: "left"}, name)),
      ),
    );
  const row = (values) =>
    h(
      "tr",
      {},
      values.map((value) => h("td", {class: "left"}, value)),
    );
  const table = (names, rows) =>
    h("div", {class: "scroll", tabindex: "0"}, h("table", {}, heads(names), h("tbody", {}, rows.map(row))));

  function facts({program, machine, sweep, created, scenes}) {
    return list([
      ["Program", [program?.version && `zonal ${program.version}`, program?.compiler].filter(Boolean).join(", ")],
      [
        "Processor",
        [machine?.cpu, machine?.threads && Format.count(machine.threads, "thread")].filter(Boolean).join(", "),
      ],
      ["Graphics", machine?.gpu],
      ["Finished", created],
      ["Sweep file", sweep?.file],
      ["Scenes", scenes.map((scene) => `${scene.name} (${details_of(scene).join(", ")})`).join("; ")],
      ["Times", "the median of a cell's timed runs; begin_pass and radiance, without loading, scoring and output"],
      ["Intervals", "95 %, Student's t over the seeds' means"],
      [
        "Pictures",
        "kept as RGB9E5: a difference below 0.4 % of a pixel's brightest channel may be rounding. Scores are from the "
          + "full pictures.",
      ],
    ]);
  }

  function details_of({file, width, height, frame, exposure}) {
    const size = `${width} × ${height}`,
      exposed = `exposure ${Format.plain(exposure ?? 1)}`;
    return [file, size, frame ? `frame ${frame}` : "", exposed].filter(Boolean);
  }

  function references({model}) {
    if (!model.references.length) return "";
    const floor = (r) =>
      Object.entries(r.floor ?? {})
        .map(([name, value]) => `${name} ${Format.number(value)}`)
        .join(", ");
    return fold(
      "References",
      table(
        ["scene", "transport", "method", "parameters", "passes", "seeds", "time", "own error"],
        model.references.map((r) => [
          model.scene.get(r.scene)?.name ?? r.scene,
          r.transport,
          r.integrator,
          Format.parameters(r.parameters) || "defaults",
          String(r.passes),
          (r.seeds ?? []).join(", "),
          Format.duration(r.seconds),
          floor(r) || "–",
        ]),
      ),
    );
  }

  function formulas({metrics}) {
    return fold(
      "Formulas",
      table(
        ["metric", "on", "formula", "unit", "better"],
        metrics.map((metric) => [
          Metrics.label(metric),
          `${metric.values} values`,
          h("code", {}, metric.formula ?? ""),
          Format.unit(metric.unit) || "1",
          metric.better ?? "",
        ]),
      ),
    );
  }

  function drift({drift: checks}) {
    if (!checks.length) return "";
    const ratios = checks.map((check) => check.ratio);
    const [least, most] = [Math.min(...ratios).toFixed(3), Math.max(...ratios).toFixed(3)];
    const summary = `Drift of the machine: the baseline cell took ${least} to ${most} of its first time`;
    return fold(
      summary,
      h("p", {class: "note"}, "The same cell, timed between the others: its time over its first one."),
      table(
        ["after runs", "ratio"],
        checks.map((check) => [String(check.after), check.ratio.toFixed(3)]),
      ),
    );
  }

  return {set_up};
})();
