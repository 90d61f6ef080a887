// Charts of plotly, which the page holds compressed: curves of figures, and stresses behind a slider.
addEventListener("load", async () => {
  const script = document.createElement("script");
  const packed = Uint8Array.from(atob(byId("plotly").textContent), (letter) => letter.charCodeAt(0));
  script.textContent = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  document.head.append(script);
  const style = getComputedStyle(document.body), COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"];
  const axis = { gridcolor: "rgba(128,128,128,0.25)", zerolinecolor: "rgba(128,128,128,0.6)", automargin: true };
  const common = { paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: style.color, size: 13 },
    margin: { l: 60, r: 16, t: 36, b: 46 }, legend: { orientation: "h", x: 0, y: 1, yanchor: "bottom" }, modebar: { bgcolor: "rgba(0,0,0,0)" }, hovermode: "closest", dragmode: innerWidth < 600 ? false : "zoom" };
  const draw = (box, data, layout) => Plotly.react(box, data, { ...common, ...layout,
    xaxis: { ...axis, ...layout.xaxis }, yaxis: { ...axis, ...layout.yaxis } }, { responsive: true, displaylogo: false, displayModeBar: "hover" });

  const charts = JSON.parse(byId("charts-data").textContent);
  for (const box of document.querySelectorAll(".chart[data-chart]")) {
    const { data, layout } = charts[box.dataset.chart];
    draw(box, data, layout);
  }

  const large = JSON.parse(byId("explorer-data").textContent);
  if (large) {
    const slider = byId("state"), chosen = byId("stress"), held = new Set();
    const places = (state, values) => values.map((value) => value === null ? null : large.place[state][1] + large.place[state][0] * value);
    const show = () => {
      const now = Number(slider.value), states = [...new Set([now, ...held])];
      byId("which").textContent = large.states[now];
      large.surface.forEach(({ label, range, curves }, n) => draw(byId(`surface-${n}`), states.flatMap((state, k) =>
        Object.entries(curves).map(([method, values], m, all) => ({
          x: places(state, large.X), y: values[state], name: `${states.length > 1 ? `${large.states[state]}, ` : ""}${method}`,
          mode: method === "finite elements" && all.length > 1 ? "markers" : "lines", connectgaps: false,
          line: { color: COLOURS[k % 5], width: 2 }, marker: { color: COLOURS[k % 5], size: 5, symbol: "circle-open" },
        }))), { xaxis: { title: { text: large.x }, range: [-2, 2].map((end) => places(now, [end])[0]) }, yaxis: { title: { text: label }, range },
        shapes: [{ type: "rect", yref: "paper", x0: places(now, [-1])[0], x1: places(now, [1])[0], y0: 0, y1: 1, layer: "below", line: { width: 0 }, fillcolor: "rgba(128,128,128,0.13)" }] }));
      if (!large.maps) return;
      const { X, Y, depth, stresses } = large.maps, { label, limit, signed, values } = stresses[chosen.value];
      draw(byId("map"), [{ type: "heatmap", x: places(now, X), y: Y.map((y) => y * large.place[now][0]), z: values[now], zsmooth: "best",
        zmin: signed ? -limit : 0, zmax: limit, colorscale: signed ? "RdBu" : "Viridis", colorbar: { title: { text: label, side: "right" }, thickness: 14 },
        hovertemplate: `X = %{x:.4g}, Y = %{y:.4g}<br>%{z:.4g}<extra>${label}</extra>` }],
        { xaxis: { title: { text: large.x } }, yaxis: { title: { text: depth }, scaleanchor: "x" } });
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
