"use strict";
// The page: takes the results when data.js hands them over, and keeps what its parts show in step.

window.zonal_results = (results) => {
  const model = Model.prepare(results);
  const page = {
    model,
    scene: model.scenes.length > 4 ? model.scenes[0].id : null, // null: all of them
    metric: model.metrics[0],
    hidden: new Set(), // ids of methods the legend has switched off
    scenes: () => model.scenes.filter((scene) => page.scene === null || scene.id === page.scene),
    show_image: (cell, item) => Viewer.show(cell, item),
    redraw: () => [Chart, Stability].forEach((part) => part.draw(page)),
  };

  introduce(model);
  controls(page);
  document.querySelector("main").hidden = false;
  // What one part stumbles over must not cost the reader the others.
  for (const part of [Chart, Viewer, Table, Stability, Manifest]) attempt(() => part.set_up(page));
};

function attempt(step) {
  try {
    step();
  } catch (error) {
    const problem = document.getElementById("problem");
    problem.textContent = `A part of this page could not be drawn: ${error.message}`;
    problem.hidden = false;
    console.error(error);
  }
}

/// Title, description and the counts a reader asks for first.
function introduce(model) {
  const {sweep, cells} = model;
  const title = sweep?.title || sweep?.name || "Sweep";
  document.title = `${title} · Zonal sweep`;
  document.getElementById("title").textContent = title;
  document.getElementById("description").textContent = sweep?.description ?? "";
  const having = (status) => cells.filter((cell) => cell.status === status).length;
  const facts = [
    Format.count(model.methods.length, "method"),
    Format.count(model.scenes.length, "scene"),
    Format.count(cells.length, "cell"),
    having("failed") ? `${having("failed")} failed` : "none failed",
    having("not_reached") ? `${having("not_reached")} missed their budget` : null,
    [model.machine?.cpu, model.machine?.gpu].filter(Boolean).join(", "),
    (model.created ?? "").slice(0, 10),
  ];
  document.getElementById("facts").replaceChildren(...facts.filter(Boolean).map((fact) => h("li", {}, fact)));
  document.getElementById("problem").hidden = true;
}

/// The bar that follows the reader down the page: scene and metric hold for charts, table and stability.
function controls(page) {
  const {model} = page;
  const scenes = [
    {value: null, label: "All scenes"},
    ...model.scenes.map((scene) => ({value: scene.id, label: scene.name})),
  ];
  const group = segments("Scene", scenes, page.scene, (scene) => {
    page.scene = scene;
    if (scene) Viewer.show_scene(scene);
    page.redraw();
    Table.draw(page);
  });
  if (model.scenes.length > 1) document.getElementById("scenes").replaceWith(group);
  const metric = document.getElementById("metric");
  metric.replaceChildren(...model.metrics.map((m, i) => h("option", {value: i}, Metrics.label(m))));
  metric.addEventListener("change", () => {
    page.metric = model.metrics[Number(metric.value)];
    page.redraw();
    Table.draw(page);
  });
  document.getElementById("controls").hidden = false;
}

window.addEventListener("load", () => {
  const problem = document.getElementById("problem");
  if (document.querySelector("main").hidden)
    problem.textContent = "data.js, which holds the results, is missing beside this page or cannot be read.";
});
