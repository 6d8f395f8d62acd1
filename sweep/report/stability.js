"use strict";
// How much a method's score depends on its seed: one strip of seeds for each group.

const Stability = (() => {
  function set_up(page) {
    on_resize(document.getElementById("strips"), () => draw(page));
  }

  function draw(page) {
    const panels = document.getElementById("strips"),
      note = document.getElementById("strips-note");
    if (!window.ZonalCharts) {
      panels.replaceChildren();
      note.textContent =
        "Left out, since this report was made by a build without Node; the table has intervals and worst seeds.";
      return;
    }
    panels.replaceChildren(
      ...page.scenes().map((scene) => h("figure", {"data-scene": scene.id}, h("figcaption", {}, scene.name))),
    );
    for (const figure of panels.children) {
      const rows = rows_of(page, figure.dataset.scene);
      const axis = Metrics.axis(page.metric);
      figure.append(
        rows.length === 0
          ? h("p", {class: "empty"}, "No group has two seeds.")
          : ZonalCharts.strips({
              width: Math.max(280, figure.clientWidth),
              rows,
              x_label: axis.label,
              x_kind: axis.kind,
              x_reverse: axis.reverse,
              on_hover: (seed, at) =>
                seed ? Tooltip.show(`${seed.cell.name}`, tips(page, seed), at) : Tooltip.hide(),
              on_pick: (seed) => page.show_image(seed.cell.image ? seed.cell : null, seed.cell),
            }),
      );
    }
    note.textContent =
      "A marker is one seed, the bar the 95 % interval of their mean, the ring the worst seed. Methods without "
      + "a random part have one marker on top of another.";
  }

  function rows_of(page, scene) {
    const axis = Metrics.axis(page.metric),
      key = Metrics.key(page.metric);
    const groups = page.model.groups.filter((g) => g.scene === scene && !page.hidden.has(g.method));
    return groups
      .map((group) => {
        const method = page.model.method.get(group.method),
          score = group.scores?.[key];
        const seeds = group.done
          .map((cell) => ({value: axis.value(cell.scores?.[key]), cell, name: `${cell.name}, seed ${cell.seed}`}))
          .filter((seed) => seed.value !== null);
        for (const seed of seeds)
          seed.worst = !seeds.some((other) => axis.better(seed.value, other.value)) && differ(seeds);
        const [low, high] = Metrics.bounds(axis, score);
        return {
          label: group.name,
          color: Methods.color(method),
          shape: Methods.shape(method),
          mean: axis.value(score?.mean),
          low,
          high,
          seeds,
        };
      })
      .filter((row) => row.seeds.length > 1);
  }

  const differ = (seeds) => seeds.some((seed) => seed.value !== seeds[0].value);

  const tips = (page, {cell}) => [
    ["seed", String(cell.seed)],
    ["time", Format.duration(cell.time)],
    [Metrics.heading(page.metric), Format.number(cell.scores[Metrics.key(page.metric)])],
  ];

  return {draw, set_up};
})();
