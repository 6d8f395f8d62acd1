"use strict";
// The results with their names resolved: cells know their scene and method, groups their cells, lines their points.

const Model = (() => {
  function prepare(results) {
    const model = {...results};
    for (const list of ["metrics", "scenes", "references", "methods", "cells", "groups", "drift"])
      model[list] = results[list] ?? [];
    model.scene = by_id(model.scenes);
    model.method = by_id(model.methods);
    model.reference = by_id(model.references);
    model.methods.forEach((method, index) => (method.index = index));
    model.backends = [...new Set(model.cells.map((cell) => cell.backend))];

    const items = [...model.cells, ...model.groups];
    model.told_apart_by = new Map(
      [...new Set(items.map((item) => item.method))].map((method) => [
        method,
        differing(items.filter((item) => item.method === method)),
      ]),
    );

    model.budgets_tell = budgets_tell(model.groups);
    model.cell = by_id(model.cells);
    for (const cell of model.cells) cell.name = name_of(model, cell);
    for (const group of model.groups) {
      group.members = (group.cells ?? []).map((id) => model.cell.get(id)).filter(Boolean);
      group.done = group.members.filter((cell) => cell.status !== "failed");
      group.not_reached = group.members.filter((cell) => cell.status === "not_reached").length;
      group.name = name_of(model, group);
      group.line = line_of(model, group);
    }
    return model;
  }

  const by_id = (list) => new Map(list.map((item) => [item.id, item]));

  /// "hvl, 5 bands · lights 400": without what all groups of the method share, for that is what its label is for.
  function name_of(model, item) {
    const method = model.method.get(item.method)?.label ?? item.method;
    const backend = model.backends.length > 1 ? `, ${item.backend}` : "";
    const told = Object.entries(item.varied ?? {}).filter(([name]) => model.told_apart_by.get(item.method).has(name));
    const varied = Format.parameters(Object.fromEntries(told));
    const budget = model.budgets_tell && item.budget;
    return `${method}${backend}${varied && ` · ${varied}`}${budget ? ` · ${budget}` : ""}`;
  }

  /// Whether groups exist that differ in their budget alone.
  function budgets_tell(groups) {
    const rest = groups.map(({scene, method, backend, varied}) => JSON.stringify([scene, method, backend, varied]));
    return new Set(rest).size < rest.length;
  }

  /// The parameters in which a method's groups and cells differ.
  function differing(items) {
    const values = new Map();
    for (const {varied} of items)
      for (const [name, value] of Object.entries(varied ?? {}))
        values.set(name, (values.get(name) ?? new Set()).add(JSON.stringify(value)));
    return new Set([...values].filter(([, of_name]) => of_name.size > 1).map(([name]) => name));
  }

  /// The parameter a method's line runs along: the number with the most values.
  function primary(model, method) {
    const values = new Map();
    for (const group of model.groups.filter((g) => g.method === method)) {
      for (const [name, value] of Object.entries(group.varied ?? {})) {
        if (typeof value === "number") values.set(name, (values.get(name) ?? new Set()).add(value));
      }
    }
    return [...values].sort((a, b) => b[1].size - a[1].size)[0]?.[0] ?? null;
  }

  /// Groups of one line differ in their method's primary parameter alone: {id, place along it}.
  function line_of(model, group) {
    const along = primary(model, group.method);
    const others = Object.entries(group.varied ?? {}).filter(([name]) => name !== along);
    return {
      id: JSON.stringify([group.scene, group.method, group.backend, others]),
      place: group.varied?.[along] ?? 0,
    };
  }

  /// The picture that stands for a group: its first seed that has one.
  const picture_of = (group) => group.done.find((cell) => cell.image) ?? null;

  /// References that the visible cells of a scene are scored against.
  function references_of(model, scene) {
    const used = new Set(model.cells.filter((cell) => cell.scene === scene).map((cell) => cell.reference));
    const named = model.references.filter((reference) => used.has(reference.id));
    return named.length ? named : model.references.filter((reference) => reference.scene === scene);
  }

  /// A group's error over time: the mean over seeds at each number of passes that all of them reached.
  function mean_curve(group, key) {
    const curves = group.done.map((cell) => cell.curve ?? []).filter((curve) => curve.length > 1);
    if (!curves.length) return [];
    const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
    return curves[0]
      .map(({passes}) => curves.map((curve) => curve.find((p) => p.passes === passes)))
      .filter((points) => points.every((p) => Number.isFinite(p?.scores?.[key])))
      .map((points) => ({
        passes: points[0].passes,
        seconds: mean(points.map((p) => p.seconds)),
        score: mean(points.map((p) => p.scores[key])),
      }));
  }

  return {mean_curve, picture_of, prepare, references_of};
})();
