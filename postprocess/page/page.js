"use strict";
const byId = (id) => document.getElementById(id);

// The table of many states: sorted, searched and shown a page at a time.
if (byId("table")) {
  const PAGE = 25;
  const { columns, rows } = JSON.parse(byId("states-data").textContent);
  const heads = [...document.querySelectorAll("#table th")];
  let found = rows, first = 0, order = [-1, 1];

  const told = (value, digits) =>
    value === null ? "–" : typeof value === "string" ? value : !Number.isFinite(digits) ? String(value) :
      value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6) ? Number(value.toPrecision(digits)).toExponential().replaceAll("-", "−") :
        String(Number(value.toPrecision(digits))).replace("-", "−");

  const show = () => {
    const body = document.createElement("tbody");
    for (const row of found.slice(first, first + PAGE)) {
      const line = body.insertRow();
      row.forEach((value, i) => { line.insertCell().textContent = told(value, columns[i].digits); });
    }
    byId("table").tBodies[0].replaceWith(body);
    byId("shown").textContent = found.length ? `${first + 1} to ${Math.min(first + PAGE, found.length)} of ${found.length}` : "none";
    byId("back").disabled = first === 0;
    byId("on").disabled = first + PAGE >= found.length;
  };

  // Every word has to be in a row, as it stands or as name=value.
  const fits = (row, word) => {
    const [name, value] = word.split("=");
    return row.some((cell, i) => value === undefined ? String(told(cell, columns[i].digits)).toLowerCase().includes(word) :
      columns[i].name.toLowerCase() === name && (String(cell).toLowerCase() === value || Number(value) === cell));
  };

  const arrange = () => {
    const words = byId("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    found = rows.filter((row) => words.every((word) => fits(row, word)));
    const [column, way] = order;
    if (column >= 0) found.sort((one, other) => {
      const [a, b] = [one[column], other[column]];
      return a === null ? 1 : b === null ? -1 : way * (a < b ? -1 : a > b ? 1 : 0);
    });
    heads.forEach((head, i) => i === column ? head.setAttribute("aria-sort", way > 0 ? "ascending" : "descending") : head.removeAttribute("aria-sort"));
    first = 0;
    show();
  };

  heads.forEach((head, i) => head.firstChild.addEventListener("click", () => {
    order = [i, order[0] === i ? -order[1] : 1];
    arrange();
  }));
  byId("search").addEventListener("input", arrange);
  byId("back").addEventListener("click", () => { first -= PAGE; show(); });
  byId("on").addEventListener("click", () => { first += PAGE; show(); });
  byId("save").addEventListener("click", () => {
    const cell = (value) => value === null ? "" : /[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value;
    const lines = [columns.map((column) => column.csv), ...found].map((row) => row.map(cell).join(","));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([lines.join("\n") + "\n"], { type: "text/csv" }));
    link.download = "states.csv";
    link.click();
  });
  arrange();
}

// Figures as large as the window.
for (const picture of document.querySelectorAll("figure img")) {
  const enlarge = () => {
    const large = byId("large").firstChild;
    Object.assign(large, { src: picture.src, alt: picture.alt, className: picture.className });
    byId("large").showModal();
  };
  picture.addEventListener("click", enlarge);
  picture.addEventListener("keydown", (event) => { if (event.key === "Enter") enlarge(); });
}
byId("large")?.addEventListener("click", () => byId("large").close());

byId("copy").addEventListener("click", () => {
  getSelection().selectAllChildren(byId("text"));
  navigator.clipboard?.writeText(byId("text").textContent).catch(() => {});
});
