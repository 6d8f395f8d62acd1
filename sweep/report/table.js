"use strict";
// The table of results: sorted by pressing a heading, filtered by words, with a button for each row's picture.

const Table = (() => {
  const kMost = 500; // rows drawn unless more are asked for: beyond some thousands a browser takes seconds

  // The heading pressed last comes first; those before it decide between equals.
  const state = {
    sorts: [
      {key: "scene", rising: true},
      {key: "time", rising: true},
    ],
    words: "",
    cells: false,
    all: false,
  };
  let count, body, head, table;

  function set_up(page) {
    const filter = h("input", {
      type: "search",
      id: "filter",
      placeholder: "hvl 400 failed",
      oninput: (event) => {
        state.words = event.target.value;
        fill(page);
      },
    });
    const what = [
      {value: false, label: "Means over seeds"},
      {value: true, label: "Every cell"},
    ];
    count = h("output", {class: "count"});
    head = h("thead");
    body = h("tbody");
    table = h("table", {}, h("caption", {class: "hidden"}, "Results; headings sort"), head, body);
    const link = (file) => h("a", {href: file, download: file}, file);
    document.getElementById("results").replaceChildren(
      h(
        "div",
        {class: "bar"},
        h("label", {}, "Filter ", filter),
        segments("Rows", what, state.cells, (cells) => {
          state.cells = cells;
          draw(page);
        }),
        count,
        h("span", {class: "downloads"}, "Download ", link("results.csv"), link("table.md"), link("table.tex")),
      ),
      h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Table of results"}, table),
    );
    draw(page);
  }

  function draw(page) {
    const columns = Columns.columns(page, state.cells);
    head.replaceChildren(
      h(
        "tr",
        {},
        columns.map((column) => heading(page, column)),
        h("th", {scope: "col"}, "image"),
      ),
    );
    fill(page);
  }

  function heading(page, column) {
    const press = () => {
      const [latest] = state.sorts;
      const rising = latest.key === column.key ? !latest.rising : column.best !== "high";
      state.sorts = [{key: column.key, rising}, ...state.sorts.filter((sort) => sort.key !== column.key)].slice(0, 3);
      for (const th of head.querySelectorAll("[data-key]")) mark(th);
      fill(page);
    };
    const th = h(
      "th",
      {scope: "col", "data-key": column.key, class: column.left ? "left" : null},
      h("button", {type: "button", onclick: press, title: column.hint}, column.heading),
      column.unit ? h("span", {class: "unit"}, column.unit) : null,
    );
    mark(th);
    return th;
  }

  function mark(th) {
    const [latest] = state.sorts;
    if (th.dataset.key === latest.key) th.setAttribute("aria-sort", latest.rising ? "ascending" : "descending");
    else th.removeAttribute("aria-sort");
  }

  function fill(page) {
    const columns = Columns.columns(page, state.cells),
      all = Columns.rows(page, state.cells);
    const sorts = state.sorts
      .map(({key, rising}) => ({rising, column: columns.find((c) => c.key === key)}))
      .filter((sort) => sort.column);
    const order = (x, y) =>
      sorts.reduce((so_far, {column, rising}) => so_far || compare(column.value(x), column.value(y), rising), 0);
    const words = state.words.toLowerCase().split(/\s+/).filter(Boolean);
    const rows = all.filter((row) => words.length === 0 || matches(row, columns, words)).sort(order);
    count.textContent =
      rows.length === all.length
        ? Format.count(rows.length, "row")
        : `${rows.length} of ${Format.count(all.length, "row")}`;
    const shown = state.all ? rows : rows.slice(0, kMost);
    body.replaceChildren(...shown.map((row) => line(page, columns, row)));
    if (rows.length > shown.length)
      body.append(
        h(
          "tr",
          {},
          h(
            "td",
            {colspan: columns.length + 1, class: "left"},
            h(
              "button",
              {
                type: "button",
                onclick: () => {
                  state.all = true;
                  fill(page);
                },
              },
              `Show all ${rows.length} rows`,
            ),
          ),
        ),
      );
  }

  function line(page, columns, row) {
    const picture = row.group ? Model.picture_of(row.group) : row.cell.image ? row.cell : null;
    const failed = row.cell?.status === "failed";
    return h(
      "tr",
      {class: failed ? "failed" : null, "data-status": row.cell?.status},
      columns.map((column) =>
        h(
          "td",
          {class: [column.left && "left", column.chosen && "chosen", column.key].filter(Boolean).join(" ")},
          column.show ? column.show(row) : Format.number(column.value(row)),
        ),
      ),
      h(
        "td",
        {},
        picture
          ? h(
              "button",
              {
                type: "button",
                class: "view",
                "aria-label": `Show the picture of ${row.item.name}`,
                onclick: () => page.show_image(picture),
              },
              "view",
            )
          : "–",
      ),
    );
  }

  function matches(row, columns, words) {
    const text = columns
      .filter((column) => column.left)
      .map((column) => column.value(row))
      .join(" ")
      .toLowerCase();
    return words.every((word) => text.includes(word));
  }

  /// What was not measured comes last whichever way the column is sorted; texts count the numbers inside them.
  function compare(a, b, rising) {
    const unknown = (v) => v === null || v === undefined || v === "";
    if (unknown(a) || unknown(b)) return Number(unknown(a)) - Number(unknown(b));
    const order =
      typeof a === "string" && Number.isNaN(number(a))
        ? a.localeCompare(b, "en", {numeric: true})
        : number(a) - number(b);
    return rising ? order : -order;
  }

  const number = (v) => (v === "inf" ? Infinity : typeof v === "number" ? v : NaN);

  return {draw, set_up};
})();
