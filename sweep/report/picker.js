"use strict";
// The choice of one side of the viewer: a group or a reference, and which of its seeds.

/// The pictures of a scene: groups with theirs by seed, in the order of methods, then references. A picture is
/// {file, name, label, seed, method, group, truth: file of what it is scored against}.
function pictures_of(model, scene) {
  const truth = (cell) => model.reference.get(cell.reference)?.image ?? null;
  const groups = model.groups.filter((group) => group.scene === scene);
  const of_groups = model.methods
    .flatMap((method) =>
      groups
        .filter((g) => g.method === method.id)
        .map((group) => ({
          key: `group ${group.id}`,
          name: group.name,
          method,
          group,
          pictures: group.done
            .filter((cell) => cell.image)
            .map((cell) => ({file: cell.image, name: group.name, seed: cell.seed, cell, truth: truth(cell)})),
        })),
    )
    .filter((choice) => choice.pictures.length);
  const of_references = Model.references_of(model, scene)
    .filter((r) => r.image)
    .map((reference) => ({
      key: `reference ${reference.id}`,
      name: "reference",
      label: `reference: ${reference.transport}`,
      reference,
      method: null,
      pictures: [{file: reference.image, name: "reference", seed: null, truth: reference.image}],
    }));
  return {groups: of_groups, references: of_references, all: [...of_groups, ...of_references]};
}

class Picker {
  /// `letter`: "A" or "B"; on_pick() after each change.
  constructor(letter, on_pick) {
    Object.assign(this, {
      letter,
      on_pick,
      choices: {groups: [], references: [], all: []},
      choice: null,
      picture: null,
    });
    this.last = new Map(); // method id -> the choice last shown of it
    this.select = h("select", {
      "aria-label": `Picture ${letter}`,
      onchange: () => this.choose(this.choices.all.find((c) => c.key === this.select.value)),
    });
    this.seeds = h("select", {
      "aria-label": `Seed of picture ${letter}`,
      onchange: () => this.choose(this.choice, Number(this.seeds.value)),
    });
    this.element = h("span", {class: "picker"}, h("b", {}, letter), this.select, this.seeds);
  }

  fill(choices) {
    this.choices = choices;
    this.last.clear();
    const methods = [...new Set(choices.groups.map((choice) => choice.method))];
    const options = (list) => list.map((choice) => h("option", {value: choice.key}, choice.label ?? choice.name));
    const number = (i) => (i < 9 ? `${i + 1}  ` : "");
    this.select.replaceChildren(
      ...methods.map((method, i) =>
        h(
          "optgroup",
          {label: `${number(i)}${method.label ?? method.id}`},
          options(choices.groups.filter((c) => c.method === method)),
        ),
      ),
      ...(choices.references.length ? [h("optgroup", {label: "0  reference"}, options(choices.references))] : []),
    );
  }

  /// `seed`: null for the first there is.
  choose(choice, seed = null) {
    if (!choice) return;
    this.choice = choice;
    this.picture = choice.pictures.find((p) => p.seed === seed) ?? choice.pictures[0];
    if (choice.method) this.last.set(choice.method.id, choice);
    this.select.value = choice.key;
    this.seeds.replaceChildren(...choice.pictures.map((p) => h("option", {value: p.seed}, `seed ${p.seed}`)));
    this.seeds.value = String(this.picture.seed);
    this.seeds.hidden = choice.pictures.length < 2;
    this.on_pick();
  }

  /// What is shown, with its seed where there is a choice.
  title() {
    return this.choice.pictures.length > 1 ? `${this.picture.name}, seed ${this.picture.seed}` : this.picture.name;
  }

  /// The n-th method (from 1), or the reference (0). Where a method has several groups: the one shown last; pressed
  /// again, the next one; a first time, the one nearest in time to what is shown, for that is the fair comparison.
  choose_number(n) {
    const methods = [...new Set(this.choices.groups.map((choice) => choice.method))];
    if (n > methods.length) return;
    const list = n === 0 ? this.choices.references : this.choices.groups.filter((c) => c.method === methods[n - 1]);
    const now = list.indexOf(this.choice);
    if (now >= 0) return this.choose(list[(now + 1) % list.length]);
    const time = (choice) => Math.log(choice?.group?.time?.mean || 1);
    const nearest = [...list].sort(
      (a, b) => Math.abs(time(a) - time(this.choice)) - Math.abs(time(b) - time(this.choice)),
    )[0];
    this.choose((n > 0 && this.last.get(methods[n - 1].id)) || nearest);
  }
}
