// A plot of curves over one abscissa, with its own legend, tools and keyboard.
const HEIGHT = 250;

class Plot {
  // spec: {key, title, unit, xLabel, xs, series: [{name, y, on, single}], timed, window, marks, levels, band, scaleOf}
  constructor(spec, box) {
    Object.assign(this, spec);
    this.box = box;
    this.shownOn = this.series.map(s => s.on !== false);
    // What shows at first gets the colors that differ most.
    let on = 0, off = this.shownOn.filter(Boolean).length;
    this.paint = this.shownOn.map((v, i) => this.series[i].paint ?? (v ? on++ : off++));
    this.curves = el("div", { class: "curves", role: "group", "aria-label": "Curves" });
    this.outputs = this.series.map((s, i) => {
      const out = el("output"), swatch = el("i");
      const button = el("button", { type: "button", "aria-pressed": String(this.shownOn[i]), onclick: () => this.toggle(i) }, swatch, s.name, out);
      this.curves.append(button);
      return { out, swatch, button };
    });
    this.where = el("output", { class: "note" });
    this.frame = el("div", { class: "canvas", tabindex: "0", role: "group", "aria-roledescription": "plot", "aria-label": `${spec.title}, plot. Arrow keys move the cursor, plus and minus zoom, 0 shows all.` });
    this.now = el("div", { class: "now", hidden: true });
    this.note_ = el("p", { class: "note" }, spec.note || "");
    box.append(this.curves, this.frame, this.where, this.note_);
    this.frame.addEventListener("keydown", e => this.key_(e));
    this.build();
    repaints.push(() => this.rebuild());
    new ResizeObserver(() => this.fit()).observe(this.frame);
    if (this.timed) {
      pointed.on((t, from) => { if (from !== this) this.point(t); });
      zoomed.on((range, from) => { if (from !== this && this.u) this.quietly(() => this.u.setScale("x", { min: range[0], max: range[1] })); });
      played.on(t => this.mark(t));
    }
  }

  data() {
    const pick = s => this.scaleOf ? this.scaleOf(s.y) : s.y;
    if (!this.tables) return [this.xs, ...this.series.map(pick)];
    const tables = this.series.map(s => [s.x, pick(s)]);
    if (this.band) tables.unshift([this.band.x, this.band.low], [this.band.x, this.band.high]);
    return uPlot.join(tables.map(t => t.map(a => Array.from(a, v => Number.isNaN(v) ? null : v))));
  }

  build() {
    const ink = css("--ink"), grid = css("--grid");
    this.first = this.band && this.tables ? 3 : 1;  // the band is drawn first, below the curves
    const axis = { stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
    const format = (u, splits) => splits.map(v => tickText(v, splits));
    const series = this.series.map((s, i) => ({ label: s.name, stroke: curveColor(this.paint[i]), dash: curveDash(this.paint[i]), width: 1.5, show: this.shownOn[i], points: { show: Boolean(this.dots && s.y.length <= 120), size: 6 }, scale: "y" }));
    if (this.first > 1) for (let i = 0; i < 2; i++) series.unshift({ label: "all", stroke: css("--band"), width: 0.5, points: { show: false }, scale: "y" });
    const nearest = (u, s, i) => {
      if (s === 0 || u.data[s][i] != null) return i;
      for (let d = 1; d < u.data[s].length; d++) { if (u.data[s][i - d] != null) return i - d; if (u.data[s][i + d] != null) return i + d; }
      return i;
    };
    const options = {
      width: Math.max(this.frame.clientWidth, 200), height: HEIGHT, legend: { show: false },
      scales: { x: { time: false }, y: { range: (u, a, b) => reach(a, b) } },
      series: [{}, ...series], bands: this.first > 1 ? [{ series: [2, 1], fill: css("--band"), dir: 0 }] : [],
      axes: [{ ...axis, label: this.xLabel, values: format, labelSize: 18, size: 34 }, { ...axis, label: this.unitNow(), values: format, size: 62, labelSize: 18, space: 34 }],
      cursor: { drag: { x: true, y: false }, points: { size: 7 }, dataIdx: this.tables ? nearest : undefined },
      hooks: {
        setCursor: [u => this.moved(u)],
        setScale: [(u, key) => { if (key === "x") { this.place(); if (this.timed && !this.quiet) zoomed.tell([u.scales.x.min, u.scales.x.max], this); } }],
        draw: [u => this.extras(u)],
      },
    };
    const data = this.data();
    // Where few points stand on the screen they show as such; gaps (nan) stay gaps.
    this.u = new uPlot(options, data.map((a, i) => i && !this.tables && a.some(Number.isNaN) ? Array.from(a, v => Number.isNaN(v) ? null : v) : a), this.frame);
    this.u.over.append(this.now);
    if (this.pick) {
      let down = null;
      this.u.over.style.cursor = "pointer";
      this.u.over.addEventListener("mousedown", e => { down = e.clientX; });
      this.u.over.addEventListener("click", e => { if (down != null && Math.abs(e.clientX - down) < 4) this.picked(); });
    }
    if (!this.full) {
      this.full = [this.u.data[0][0], this.u.data[0][this.u.data[0].length - 1]];
      if (this.window) this.quietly(() => this.u.setScale("x", { min: this.window[0], max: this.window[1] }));
    }
    this.outputs.forEach((o, i) => { o.swatch.style.background = curveColor(this.paint[i]); });
    this.place();
  }

  unitNow() { return this.unitOf ? this.unitOf() : this.unit; }

  rebuild() {
    if (!this.u) return;
    const { min, max } = this.u.scales.x;
    this.u.destroy();
    this.quietly(() => { this.build(); this.u.setScale("x", { min, max }); });
  }

  fit() {
    const width = this.frame.clientWidth;
    if (this.u && width > 50 && Math.abs(width - this.u.width) > 1) this.u.setSize({ width, height: HEIGHT });
    this.place();
  }

  quietly(f) { this.quiet = true; try { f(); } finally { this.quiet = false; } }

  extras(u) {
    const { ctx } = u, px = devicePixelRatio || 1;
    ctx.save();
    ctx.strokeStyle = css("--soft"); ctx.lineWidth = px; ctx.setLineDash([3 * px, 3 * px]);
    const { left, top, width, height } = u.bbox;
    for (const x of this.marks || []) {
      const at = u.valToPos(x, "x", true);
      if (at >= left && at <= left + width) { ctx.beginPath(); ctx.moveTo(at, top); ctx.lineTo(at, top + height); ctx.stroke(); }
    }
    ctx.setLineDash([8 * px, 4 * px]);
    for (const y of this.levels || []) {
      const at = u.valToPos(y, "y", true);
      if (at >= top && at <= top + height) { ctx.beginPath(); ctx.moveTo(left, at); ctx.lineTo(left + width, at); ctx.stroke(); }
    }
    ctx.restore();
  }

  toggle(i) {
    this.shownOn[i] = !this.shownOn[i];
    this.outputs[i].button.setAttribute("aria-pressed", String(this.shownOn[i]));
    this.u.setSeries(i + this.first, { show: this.shownOn[i] });
  }

  moved(u) {
    const inside = u.cursor.left >= 0;
    const x = inside ? u.posToVal(u.cursor.left, "x") : null;
    this.series.forEach((s, i) => {
      const at = inside ? u.cursor.idxs[i + this.first] ?? u.cursor.idx : null;
      this.outputs[i].out.textContent = at == null ? "" : shown(u.data[i + this.first][at], 5);
    });
    const at = u.cursor.idx;
    this.where.textContent = inside && at != null ? `${this.xLabel.replace(/ \[.*/, "")} ${shown(u.data[0][at], 6)} ${(this.xLabel.match(/\[(.*)\]/) || [])[1] || ""}, values in ${this.unitNow()}` : "";
    if (this.timed && !this.quiet) pointed.tell(x, this);
  }

  // The curve that is nearest to the cursor at its abscissa.
  picked() {
    const u = this.u;
    if (u.cursor.left < 0) return;
    let best = Infinity, chosen = -1;
    this.series.forEach((s, i) => {
      const at = u.cursor.idxs[i + this.first];
      if (!this.shownOn[i] || at == null) return;
      const d = Math.hypot(u.valToPos(u.data[0][at], "x") - u.cursor.left, u.valToPos(u.data[i + this.first][at], "y") - u.cursor.top);
      if (d < best) { best = d; chosen = i; }
    });
    if (chosen >= 0) this.pick(this.series[chosen], u.data[0][u.cursor.idxs[chosen + this.first]]);
  }

  point(t) {
    if (!this.u) return;
    this.quietly(() => {
      if (t == null) this.u.setCursor({ left: -10, top: -10 });
      else { const left = this.u.valToPos(t, "x"); this.u.setCursor(left >= 0 && left <= this.u.over.clientWidth ? { left, top: -10 } : { left: -10, top: -10 }); }
    });
  }

  mark(t) { this.marked = t; this.place(); }
  place() {
    if (!this.u || this.marked == null) return;
    const left = this.u.valToPos(this.marked, "x");
    this.now.hidden = !(left >= 0 && left <= this.u.over.clientWidth);
    this.now.style.left = `${left}px`;
  }

  key_(e) {
    const u = this.u, width = u.over.clientWidth, { min, max } = u.scales.x;
    const zoom = f => {
      const mid = u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : (min + max) / 2;
      u.setScale("x", { min: Math.max(this.full[0], mid - (mid - min) * f), max: Math.min(this.full[1], mid + (max - mid) * f) });
    };
    if (e.key === "ArrowLeft" || e.key === "ArrowRight") {
      const step = (e.key === "ArrowLeft" ? -1 : 1) * (e.shiftKey ? 25 : 4);
      const left = Math.min(width, Math.max(0, (u.cursor.left >= 0 ? u.cursor.left : width / 2) + step));
      u.setCursor({ left, top: u.over.clientHeight / 2 });
      say(this.series.map((s, i) => this.shownOn[i] ? `${s.name} ${this.outputs[i].out.textContent}` : "").filter(Boolean).slice(0, 4).join(", ") + `; ${this.where.textContent}`);
    } else if (e.key === "+" || e.key === "=") zoom(0.6);
    else if (e.key === "-") zoom(1 / 0.6);
    else if (e.key === "0" || e.key === "Home") u.setScale("x", { min: this.full[0], max: this.full[1] });
    else if (e.key === "Enter" && this.pick) this.picked();
    else if (e.key === "Escape") u.setCursor({ left: -10, top: -10 });
    else return;
    e.preventDefault();
  }

  svg() {
    const { x, y } = this.u.scales, curves = [];
    this.series.forEach((s, i) => { if (this.shownOn[i]) curves.push({ name: s.name, color: LIGHT[this.paint[i] % 6], dash: curveDash(this.paint[i]), x: this.u.data[0], y: this.u.data[i + this.first] }); });
    return plotSvg({ title: this.title, xLabel: this.xLabel, yLabel: this.unitNow(), xRange: [x.min, x.max], yRange: [y.min, y.max], curves });
  }

  table() {
    const unit = this.unitNow();
    if (this.tables) return this.series.flatMap(s => [{ name: `${s.name}: ${this.xLabel}`, values: s.x }, { name: `${s.name} [${unit}]`, values: s.y, single: true }]);
    return [{ name: this.xLabel, values: this.xs }, ...this.series.map(s => ({ name: `${s.name} [${unit}]`, values: this.scaleOf ? this.scaleOf(s.y) : s.y, single: true }))];
  }
}

const LIGHT = ["#0072b2", "#b84a00", "#00785a", "#a8437f", "#5b4bb5", "#806300"];

// Limits of an axis; curves that do not move beyond rounding stand in the middle.
function reach(a, b) {
  if (a == null || !Number.isFinite(a) || !Number.isFinite(b)) return [-1, 1];
  const size = Math.max(Math.abs(a), Math.abs(b));
  if (b - a <= 1e-6 * size || size < 1e-12) { const half = Math.max(0.05 * size, 1e-6); return [(a + b) / 2 - half, (a + b) / 2 + half]; }
  const margin = 0.06 * (b - a);
  return [a - margin, b + margin];
}

// A block with a heading, tools and a plot in it; a closed one is drawn when it is opened.
function plotBlock(spec, parent) {
  const closed = spec.open === false;
  const box = el(closed ? "details" : "div", { class: "plot", id: `plot-${spec.key}` });
  const title = el("h3", {}, `${spec.title} [${spec.unit}]`);
  const tools = el("div", { class: "tools" });
  let plot = null;
  const make = () => { if (!plot) { plot = new Plot(spec, box); box.plot = plot; } return plot; };
  const words = spec.title;
  tools.append(
    el("button", { type: "button", "aria-label": `Show all of: ${words}`, onclick: () => { const p = make(); p.u.setScale("x", { min: p.full[0], max: p.full[1] }); } }, "All"),
    el("button", { type: "button", "aria-label": `Download as SVG: ${words}`, onclick: () => download(make().svg(), fileName(spec.key, "svg"), "image/svg+xml") }, "SVG"),
    el("button", { type: "button", "aria-label": `Download as CSV: ${words}`, onclick: () => download(csv(make().table()), fileName(spec.key, "csv"), "text/csv") }, "CSV"));
  if (closed) {
    box.append(el("summary", {}, title.textContent), el("div", { class: "plot-head" }, el("span"), tools));
    box.addEventListener("toggle", () => { if (box.open) make().fit(); });
    parent.append(box);
  } else {
    box.append(el("div", { class: "plot-head" }, title, tools));
    parent.append(box);
    make();
  }
  return box;
}
