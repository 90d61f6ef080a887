// Stresses on the surface of one state: both methods, zoomed by dragging, read by pointing.
{
  const { unit, X, states, quantities, methods, values } = JSON.parse(byId("curves-data").textContent);
  const box = byId("curves"), svg = box.querySelector("svg"), reading = box.querySelector("output");
  const COLOURS = ["var(--one)", "var(--two)"], LEFT = 58, RIGHT = 12, TOP = 22, BELOW = 40;
  const HOME = [Math.max(X[0], -3), Math.min(X[X.length - 1], 3)];
  let range = HOME, from = null;

  for (const [list, names] of [["state", states], ["quantity", quantities]])
    names.forEach((name, i) => byId(list).add(new Option(name, i)));

  const shown = () => methods.map((_, method) => values[method][byId("quantity").value][byId("state").value]);
  const draw = (kind, attributes, text) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", kind);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    return svg.appendChild(element);
  };
  const short = (value) => String(Number(value.toPrecision(4))).replace("-", "−");
  const ticks = (low, high, count) => {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw);
    const result = [];
    for (let k = Math.ceil(low / step); k * step <= high; k++) result.push(k * step);
    return result;
  };
  // Sharp edges are infinite: where the rest would be flat the scale leaves out what is next to them, and says so.
  const heights = (curves) => {
    const next = 0.015 * (range[1] - range[0]), sorted = (values) => values.sort((a, b) => a - b);
    const within = (beside) => sorted(curves.flatMap((curve) => curve.filter((y, i) =>
      y !== null && X[i] >= range[0] && X[i] <= range[1] && Math.abs(Math.abs(X[i]) - 1) > beside)));
    const all = within(-1), most = within(next), inside = most.length ? most : all;
    if (!all.length) return [-1, 1, ""];
    const at = (share) => inside[Math.round(share * (inside.length - 1))];
    const [low, high] = [at(0.04), at(0.96)], room = 0.25 * (high - low || Math.abs(high) || 1), last = all.length - 1;
    if (all[last] - all[0] <= 4 * (high - low)) return [all[0] - room / 4, all[last] + room / 4, ""];
    const ends = [Math.max(low - room, inside[0] - room / 4), Math.min(high + room, inside[inside.length - 1] + room / 4)];
    const cut = all[0] < ends[0] || all[last] > ends[1];
    return [...ends, cut ? `; cut, reaches from ${short(all[0])} to ${short(all[last])} here` : ""];
  };
  // Between two places with a sharp edge between them a curve goes from one infinity to the other.
  const parted = (i, one, other, span) => [-1, 1].some((edge) => (X[i - 1] < edge) !== (X[i] < edge)) && Math.abs(one - other) > span;

  let place = null;
  const redraw = () => {
    const { width, height } = svg.getBoundingClientRect(), curves = shown(), [low, high, cut] = heights(curves);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const right = width - RIGHT, bottom = height - BELOW;
    const x = (value) => LEFT + (value - range[0]) / (range[1] - range[0]) * (right - LEFT);
    const y = (value) => bottom - (value - low) / (high - low) * (bottom - TOP);
    place = { x, y, back: (pixel) => range[0] + (pixel - LEFT) / (right - LEFT) * (range[1] - range[0]), right, bottom };
    const under = [Math.max(x(-1), LEFT), Math.min(x(1), right)];
    if (under[1] > under[0]) draw("rect", { class: "band", x: under[0], y: bottom, width: under[1] - under[0], height: 5 });
    for (const tick of ticks(range[0], range[1], width / 110)) {
      draw("line", { class: "grid", x1: x(tick), x2: x(tick), y1: TOP, y2: bottom });
      draw("text", { x: x(tick), y: bottom + 18, "text-anchor": "middle" }, short(tick));
    }
    for (const tick of ticks(low, high, height / 60)) {
      draw("line", { class: Math.abs(tick) < 1e-12 ? "zero" : "grid", x1: LEFT, x2: right, y1: y(tick), y2: y(tick) });
      draw("text", { x: LEFT - 6, y: y(tick) + 4, "text-anchor": "end" }, short(tick));
    }
    draw("text", { x: right, y: height - 6, "text-anchor": "end" }, "X/a (dimensionless)");
    draw("text", { x: 4, y: 14 }, `${quantities[byId("quantity").value]} ${unit}${cut}`);
    const clip = draw("clipPath", { id: "inside" });
    clip.appendChild(draw("rect", { x: LEFT, y: TOP, width: right - LEFT, height: bottom - TOP }));
    curves.forEach((curve, method) => {
      let path = "", pen = false;
      curve.forEach((value, i) => {
        if (value === null) { pen = false; return; }
        if (pen && parted(i, curve[i - 1], value, high - low)) pen = false;
        path += `${pen ? "L" : "M"}${x(X[i]).toFixed(1)} ${Math.max(-1e4, Math.min(1e4, y(value))).toFixed(1)}`;
        pen = true;
      });
      draw("path", { d: path, stroke: COLOURS[method], "clip-path": "url(#inside)", "stroke-dasharray": method ? "6 5" : "none" });
    });
  };

  const nearest = (value) => X.reduce((best, at, i) => Math.abs(at - value) < Math.abs(X[best] - value) ? i : best, 0);
  const pixel = (event) => event.clientX - svg.getBoundingClientRect().left;
  svg.addEventListener("pointerdown", (event) => { from = pixel(event); event.preventDefault(); });
  svg.addEventListener("pointermove", (event) => {
    const i = nearest(place.back(pixel(event)));
    svg.querySelectorAll(".read").forEach((element) => element.remove());
    draw("line", { class: "read zero", x1: place.x(X[i]), x2: place.x(X[i]), y1: TOP, y2: place.bottom });
    if (from !== null && Math.abs(pixel(event) - from) > 4)
      draw("rect", { class: "read band", x: Math.min(from, pixel(event)), y: TOP, width: Math.abs(pixel(event) - from), height: place.bottom - TOP });
    const told = shown().map((curve, method) => `${methods[method]}: ${curve[i] === null ? "–" : short(curve[i])}`);
    reading.textContent = `X/a = ${short(X[i])}; ${told.join("; ")}`;
  });
  addEventListener("pointerup", (event) => {
    if (from === null) return;
    const ends = [from, pixel(event)].map(place.back).sort((a, b) => a - b);
    if (Math.abs(pixel(event) - from) > 8) { range = [Math.max(ends[0], X[0]), Math.min(ends[1], X[X.length - 1])]; redraw(); }
    from = null;
  });
  const zoom = (next) => () => { range = next(); redraw(); };
  svg.addEventListener("dblclick", zoom(() => HOME));
  byId("all").addEventListener("click", zoom(() => HOME));
  byId("left").addEventListener("click", zoom(() => [-1.1, -0.9]));
  byId("right").addEventListener("click", zoom(() => [0.9, 1.1]));
  for (const list of ["state", "quantity"]) byId(list).addEventListener("change", redraw);
  redraw();
  new ResizeObserver(redraw).observe(svg);

  const legend = document.createElement("p");
  legend.className = "faint";
  methods.forEach((method, i) => {
    const name = legend.appendChild(document.createElement("span"));
    Object.assign(name.style, { color: COLOURS[i], marginRight: "1rem" });
    name.textContent = `${i ? "- -" : "—"} ${method}`;
  });
  svg.after(legend);
}
