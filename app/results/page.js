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

// Charts of plotly, which the page holds compressed: curves of figures, and stresses behind a slider.
addEventListener("load", async () => {
  const script = document.createElement("script");
  const packed = Uint8Array.from(atob(byId("plotly").textContent), (letter) => letter.charCodeAt(0));
  script.textContent = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  document.head.append(script);
  const style = getComputedStyle(document.body), COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"];
  const axis = { gridcolor: "rgba(128,128,128,0.25)", zerolinecolor: "rgba(128,128,128,0.6)", automargin: true };
  const common = { paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: style.color, size: 13 },
    margin: { l: 60, r: 16, t: 36, b: 46 }, legend: { orientation: "h", x: 0, y: -0.34, yanchor: "top" }, modebar: { bgcolor: "rgba(0,0,0,0)" }, hovermode: "closest", dragmode: innerWidth < 600 ? false : "zoom" };
  const draw = (box, data, layout) => Plotly.react(box, data, { ...common, ...layout,
    xaxis: { ...axis, ...layout.xaxis }, yaxis: { ...axis, ...layout.yaxis } }, { responsive: true, displaylogo: false, displayModeBar: "hover" });

  for (const script of document.querySelectorAll(".chart > script")) {
    const box = script.parentElement, { data, layout } = JSON.parse(script.textContent);
    box.replaceChildren();
    draw(box, data, layout);
  }

  const large = JSON.parse(byId("explorer-data").textContent);
  if (large) {
    const slider = byId("state"), chosen = byId("stress"), held = new Set();
    // Curves of a state that is held beside others have its name and a colour of their own.
    const beside = (state, k) => (trace) => ({ ...trace, name: `${large.states[state]}, ${trace.name}`,
      line: { ...trace.line, color: COLOURS[k % 5] }, marker: { ...trace.marker, color: COLOURS[k % 5] } });
    const show = () => {
      const now = Number(slider.value), states = [...new Set([now, ...held])];
      byId("which").innerHTML = large.states[now];
      large.surface.forEach((charts, n) => draw(byId(`surface-${n}`), states.length > 1 ?
        states.flatMap((state, k) => charts[state].data.map(beside(state, k))) : charts[now].data, charts[now].layout));
      if (chosen) {
        const { data, layout } = large.maps[chosen.value].charts[now];
        draw(byId("map"), data, layout);
      }
    };
    slider.addEventListener("input", show);
    byId("before").addEventListener("click", () => { slider.value = Number(slider.value) - 1; show(); });
    byId("next").addEventListener("click", () => { slider.value = Number(slider.value) + 1; show(); });
    byId("hold").addEventListener("click", () => { held.add(Number(slider.value)); show(); });
    byId("clear").addEventListener("click", () => { held.clear(); show(); });
    chosen?.addEventListener("change", show);
    show();
  }
  // On paper a chart is as wide as the page, whatever the window was.
  const every = (layout) => document.querySelectorAll(".chart.js-plotly-plot").forEach((box) => Plotly.relayout(box, layout));
  addEventListener("beforeprint", () => every({ width: 640 }));
  addEventListener("afterprint", () => every({ width: null, autosize: true }));
  document.body.dataset.ready = "yes";
});
