"use strict";
// What the table shows: its rows (groups of seeds, or every cell), and its columns with their units.

const Columns = (() => {
  /// Groups that were scored or timed, then each failed cell with its reason. `cells`: every cell instead.
  function rows(page, cells) {
    const {model} = page,
      scene = (item) => !page.scene || item.scene === page.scene;
    const failures = model.cells.filter((cell) => scene(cell) && cell.status === "failed");
    if (cells) return model.cells.filter(scene).map((cell) => ({cell, item: cell}));
    return [
      ...model.groups.filter((group) => scene(group) && group.done.length).map((group) => ({group, item: group})),
      ...failures.map((cell) => ({cell, item: cell})),
    ];
  }

  /// A column: {key, heading, unit, hint, left: not a number, best: "low" | "high" comes first, value(row): for sorting and
  /// filtering, show(row): a text or an element where that is not the number itself}.
  function columns(page, cells) {
    const {model, metric} = page,
      key = Metrics.key(metric),
      unit = Metrics.unit(metric),
      radiance = "W m⁻² sr⁻¹";
    const score = (row, k) => (row.group ? row.group.scores?.[k]?.mean : row.cell.scores?.[k]);
    const text = (k, heading, value, show) => ({key: k, heading, left: true, value, show});
    const method = (row) => model.method.get(row.item.method);
    const interval = (bounds) => ({
      value: (row) => (row.group ? half(bounds(row.group)) : null),
      show: (row) => (row.group ? Format.interval(bounds(row.group)) : "–"),
    });
    return [
      ...(model.scenes.length > 1
        ? [text("scene", "scene", (row) => model.scene.get(row.item.scene)?.name ?? row.item.scene)]
        : []),
      text(
        "method",
        "method",
        (row) => method(row)?.label ?? row.item.method,
        (row) => (method(row) ? Methods.name(method(row)) : row.item.method),
      ),
      text("parameters", "parameters", (row) => Format.parameters(row.item.varied)),
      ...(model.backends.length > 1 ? [text("backend", "backend", (row) => row.item.backend)] : []),
      ...(cells
        ? [{key: "seed", heading: "seed", value: (row) => row.cell.seed, show: (row) => String(row.cell.seed)}]
        : []),
      ...(model.groups.some((group) => group.budget) ? [text("budget", "budget", (row) => row.item.budget)] : []),
      text("status", "status", status_text, status_badges),
      {
        key: "time",
        heading: "time",
        unit: "s",
        best: "low",
        hint: "begin_pass and radiance; not loading, scoring or output",
        value: (row) => (row.group ? row.group.time?.mean : row.cell.time),
      },
      ...(cells
        ? []
        : [
            {
              key: "time_interval",
              heading: "time, 95\u00a0%",
              unit: "s",
              hint: "95 % interval of the mean over seeds",
              ...interval((group) => group.time),
            },
            ...(model.groups.some((group) => group.time_ratio)
              ? [
                  {
                    key: "ratio",
                    heading: "time ratio",
                    best: "low",
                    hint: "to the scene's first method; in the interval the same sweep again falls in 95 % of cases",
                    value: (row) => row.group?.time_ratio?.mean,
                    show: (row) => ratio_text(row.group?.time_ratio),
                  },
                ]
              : []),
          ]),
      metric_column(metric, key, score, true),
      ...(cells
        ? []
        : [
            {
              key: "interval",
              heading: `${Metrics.label(metric)}, 95\u00a0%`,
              unit,
              hint: "95 % interval of the mean over seeds",
              ...interval((group) => group.scores?.[key]),
            },
            {
              key: "worst",
              heading: "worst seed",
              unit,
              best: metric.better === "higher" ? "high" : "low",
              value: (row) => row.group?.scores?.[key]?.worst,
            },
            {
              key: "noise",
              heading: "noise, RMSE",
              unit: radiance,
              best: "low",
              hint: "RMS deviation from the mean over seeds",
              value: (row) => row.group?.noise,
            },
            {
              key: "bias_part",
              heading: "bias, RMSE",
              unit: radiance,
              best: "low",
              hint: "RMSE of the mean over seeds",
              value: (row) => row.group?.bias,
            },
          ]),
      ...model.metrics
        .filter((other) => other !== metric)
        .map((other) => metric_column(other, Metrics.key(other), score, false)),
      ...(cells && model.cells.some((cell) => cell.repeat)
        ? [text("repeat", "to repeat it", (row) => row.cell.repeat)]
        : []),
    ];
  }

  function metric_column(metric, key, score, chosen) {
    return {
      key,
      heading: Metrics.label(metric),
      unit: Metrics.unit(metric),
      hint: metric.formula,
      chosen,
      best: metric.better === "higher" ? "high" : "low",
      value: (row) => score(row, key),
    };
  }

  const ratio_text = (ratio) => (ratio ? `${Format.number(ratio.mean)} (${Format.number(ratio.low)} … ${Format.number(ratio.high)})` : "–");

  const half = (bounds) =>
    Number.isFinite(bounds?.low) && Number.isFinite(bounds?.high) ? (bounds.high - bounds.low) / 2 : null;

  /// [{kind, words}]: all that a reader should know before trusting a row.
  function status(row) {
    const {group, cell, item} = row,
      list = [];
    const missed = cell ?? group.members.find((c) => c.status === "not_reached");
    if (cell?.status === "failed")
      list.push({kind: "bad", words: `seed ${cell.seed} failed: ${cell.reason || "no reason was recorded"}`});
    if (group?.failed) list.push({kind: "bad", words: `${group.failed} of ${group.members.length} failed`});
    const how_many =
      group && group.not_reached < group.members.length ? `${group.not_reached} of ${group.members.length} ` : "";
    if (missed?.status === "not_reached") list.push({kind: "warn", words: `${how_many}not reached${aim(missed)}`});
    if (item.reference_limited) list.push({kind: "hollow", words: "reference-limited"});
    return list.length ? list : [{kind: "ok", words: "done"}];
  }

  const status_text = (row) =>
    status(row)
      .map(({words}) => words)
      .join("; ");
  const status_badges = (row) =>
    h(
      "span",
      {},
      status(row).map(({kind, words}) => h("span", {class: `badge ${kind}`}, words)),
    );

  /// What an equal-time or equal-error search wanted and got.
  function aim(cell) {
    const {kind, target, reached} = cell.search ?? {};
    if (target === undefined || target === null) return cell.reason ? `: ${cell.reason}` : "";
    const unit = kind === "equal_time" ? " s" : "";
    return `: ${Format.number(reached)}${unit} of ${Format.plain(target)}${unit}`;
  }

  return {columns, rows};
})();
