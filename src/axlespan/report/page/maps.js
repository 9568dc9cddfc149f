// Values over position and time as an image with a scale of colors.
const DIVERGING = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];
const SEQUENTIAL = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function mixed(stops, share) {
  const s = Math.min(Math.max(share, 0), 1) * (stops.length - 1), i = Math.min(Math.floor(s), stops.length - 2), f = s - i;
  return stops[i].map((c, k) => c + f * (stops[i + 1][k] - c));
}

class SpaceTime {
  constructor(spec, parent) {
    this.spec = spec;
    this.t = arrays(spec.t); this.x = arrays(spec.x); this.v = restored(spec.values);
    // Colors reach so far that rare blows, as at an end of a bare span, do not hide all else.
    const sizes = Float32Array.from(this.v, v => Math.abs(v) || 0).sort(), last = sizes[sizes.length - 1] || 1, usual = sizes[Math.floor(0.995 * (sizes.length - 1))];
    this.largest = last;
    this.most = usual > 0 && last > 2 * usual ? usual : last;
    this.image = this.painted();
    this.frame = el("div", { class: "canvas", tabindex: "0", role: "group", "aria-roledescription": "map", "aria-label": `${spec.title}, map. Largest size ${shown(this.largest)} ${spec.unit}. Arrow keys move the point that is read.` });
    this.canvas = el("canvas");
    this.tip = el("div", { class: "tip", hidden: true });
    this.frame.append(this.canvas, this.tip);
    const tools = el("div", { class: "tools" },
      el("button", { type: "button", "aria-label": `Download as SVG: ${spec.title}`, onclick: () => download(this.svg(), fileName(spec.key, "svg"), "image/svg+xml") }, "SVG"),
      el("button", { type: "button", "aria-label": `Download as CSV: ${spec.title}`, onclick: () => download(csv(this.table()), fileName(spec.key, "csv"), "text/csv") }, "CSV"));
    const box = el("div", { class: "plot", id: `map-${spec.key}` }, el("div", { class: "plot-head" }, el("h3", {}, `${spec.title} [${spec.unit}]`), tools), this.frame,
      el("p", { class: "note" }, "The dashed lines are the paths of the first and the last wheel. Each cell shows the value that is largest in size within it."
        + (this.most < last ? ` Colors end at ±${shown(this.most, 3)} ${spec.unit}; the largest size, ${shown(last)} ${spec.unit}, is reached in less than 1 % of the cells.` : "")));
    box.map = this;
    parent.append(box);
    this.frame.addEventListener("pointermove", e => { const r = this.canvas.getBoundingClientRect(); this.read(e.clientX - r.left, e.clientY - r.top); });
    this.frame.addEventListener("pointerleave", () => { this.tip.hidden = true; this.at = null; this.draw(); pointed.tell(null, this); });
    this.frame.addEventListener("keydown", e => this.key_(e));
    repaints.push(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.frame);
    pointed.on((t, from) => { if (from !== this) { this.pointedTime = t; this.draw(); } });
    played.on(t => { this.marked = t; this.draw(); });
    this.draw();
  }

  // The image itself, one pixel for a cell: time to the right, position upward.
  painted() {
    const nt = this.t.length, nx = this.x.length, canvas = el("canvas", { width: nt, height: nx });
    const ctx = canvas.getContext("2d"), image = ctx.createImageData(nt, nx);
    for (let i = 0; i < nt; i++) for (let j = 0; j < nx; j++) {
      const v = this.v[i * nx + j], p = 4 * ((nx - 1 - j) * nt + i);
      const c = Number.isNaN(v) ? [128, 128, 128] : mixed(DIVERGING, 0.5 + 0.5 * v / this.most);
      image.data[p] = c[0]; image.data[p + 1] = c[1]; image.data[p + 2] = c[2]; image.data[p + 3] = 255;
    }
    ctx.putImageData(image, 0, 0);
    return canvas;
  }

  layout() {
    const W = Math.max(this.frame.clientWidth, 220), H = 300, bar = W > 480 ? 92 : 66;
    return { W, H, L: 58, R: bar, T: 10, B: 42 };
  }

  draw() {
    const { W, H, L, R, T, B } = this.layout(), px = devicePixelRatio || 1, c = this.canvas, ctx = c.getContext("2d");
    if (c.width !== Math.round(W * px) || c.height !== H * px) { c.width = Math.round(W * px); c.height = H * px; c.style.width = `${W}px`; c.style.height = `${H}px`; }
    ctx.setTransform(px, 0, 0, px, 0, 0);
    ctx.clearRect(0, 0, W, H);
    ctx.imageSmoothingEnabled = true;
    ctx.drawImage(this.image, L, T, W - L - R, H - T - B);
    const ink = css("--ink"), soft = css("--soft");
    const t0 = this.t[0], t1 = this.t[this.t.length - 1], x0 = this.x[0], x1 = this.x[this.x.length - 1];
    const px_ = t => L + (t - t0) / (t1 - t0) * (W - L - R), py_ = x => H - B - (x - x0) / (x1 - x0) * (H - T - B);
    Object.assign(this, { px_, py_, box: { L, R, T, B, W, H, t0, t1, x0, x1 } });
    ctx.strokeStyle = soft; ctx.strokeRect(L, T, W - L - R, H - T - B);
    ctx.fillStyle = ink; ctx.font = "12px system-ui, sans-serif"; ctx.textAlign = "center";
    const ts = ticks(t0, t1, W > 480 ? 8 : 4), xs = ticks(x0, x1, 5);
    for (const t of ts) { ctx.fillText(tickText(t, ts), px_(t), H - B + 16); ctx.fillRect(px_(t), H - B, 1, 4); }
    ctx.textAlign = "right";
    for (const x of xs) { ctx.fillText(tickText(x, xs), L - 8, py_(x) + 4); ctx.fillRect(L - 4, py_(x), 4, 1); }
    ctx.textAlign = "center"; ctx.fillText("Time [s]", (L + W - R) / 2, H - 8);
    ctx.save(); ctx.translate(14, (T + H - B) / 2); ctx.rotate(-Math.PI / 2); ctx.fillText("Position [m]", 0, 0); ctx.restore();
    ctx.save(); ctx.beginPath(); ctx.rect(L, T, W - L - R, H - T - B); ctx.clip();
    ctx.setLineDash([5, 4]); ctx.lineWidth = 1.2; ctx.strokeStyle = "#000";
    for (const w of this.spec.wheels) { const p = arrays(w.a); ctx.beginPath(); for (let i = 0; i < p.length; i++) ctx.lineTo(px_(this.t[i]), py_(p[i])); ctx.stroke(); }
    ctx.setLineDash([]);
    const line = (x, color) => { ctx.strokeStyle = color; ctx.beginPath(); ctx.moveTo(x, T); ctx.lineTo(x, H - B); ctx.stroke(); };
    if (this.marked != null) { ctx.lineWidth = 2; ctx.setLineDash([6, 4]); line(px_(this.marked), "#b84a00"); ctx.setLineDash([]); }
    if (this.pointedTime != null) { ctx.lineWidth = 1; line(px_(this.pointedTime), "#333"); }
    if (this.at) { ctx.lineWidth = 1; line(px_(this.t[this.at[0]]), "#333"); ctx.beginPath(); const y = py_(this.x[this.at[1]]); ctx.moveTo(L, y); ctx.lineTo(W - R, y); ctx.stroke(); }
    ctx.restore();
    const bx = W - R + 16, bh = H - T - B;
    for (let i = 0; i < bh; i++) { ctx.fillStyle = `rgb(${mixed(DIVERGING, 1 - i / bh).map(Math.round).join(",")})`; ctx.fillRect(bx, T + i, 14, 1.5); }
    ctx.strokeRect(bx, T, 14, bh);
    ctx.fillStyle = ink; ctx.textAlign = "left";
    const vs = ticks(-this.most, this.most, 6);
    for (const v of vs) ctx.fillText(tickText(v, vs), bx + 19, T + bh * (0.5 - 0.5 * v / this.most) + 4);
  }

  read(left, top) {
    const { L, R, T, B, W, H, t0, t1, x0, x1 } = this.box;
    if (left < L || left > W - R || top < T || top > H - B) { this.tip.hidden = true; return; }
    const t = t0 + (left - L) / (W - L - R) * (t1 - t0), x = x0 + (H - B - top) / (H - T - B) * (x1 - x0);
    this.pick(near(this.t, t), near(this.x, x));
  }

  pick(i, j) {
    this.at = [i, j];
    const v = this.v[i * this.x.length + j], { W } = this.box;
    this.tip.textContent = `${shown(v)} ${this.spec.unit} at ${shown(this.x[j], 5)} m, ${shown(this.t[i], 5)} s`;
    this.tip.hidden = false;
    const left = this.px_(this.t[i]), right = left > W / 2;
    this.tip.style.left = right ? "" : `${left + 10}px`;
    this.tip.style.right = right ? `${W - left + 10}px` : "";
    this.tip.style.top = `${Math.max(0, this.py_(this.x[j]) - 30)}px`;
    this.pointedTime = null;
    this.draw();
    pointed.tell(this.t[i], this);
  }

  key_(e) {
    const step = e.shiftKey ? 10 : 1, at = this.at || [this.t.length >> 1, this.x.length >> 1];
    const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[e.key];
    if (!by) return;
    e.preventDefault();
    this.pick(Math.min(this.t.length - 1, Math.max(0, at[0] + by[0])), Math.min(this.x.length - 1, Math.max(0, at[1] + by[1])));
    say(this.tip.textContent);
  }

  svg() {
    const { title, unit } = this.spec, box = this.box;
    return plotSvg({
      title: `${title} [${unit}], from ${shown(-this.most)} (blue) to ${shown(this.most)} (red)`, xLabel: "Time [s]", yLabel: "Position [m]", xRange: [box.t0, box.t1], yRange: [box.x0, box.x1],
      curves: this.spec.wheels.map((w, i) => ({ name: w.name, color: "#000", dash: [5, 4], x: this.t, y: arrays(w.a) })),
      under: ({ L, R, T, B, W, H }) => `<image x="${L}" y="${T}" width="${W - L - R}" height="${H - T - B}" preserveAspectRatio="none" xlink:href="${this.image.toDataURL("image/png")}"/>`,
    });
  }

  table() {
    const n = this.x.length;
    return [{ name: "Time [s]", values: this.t }, ...Array.from(this.x, (x, j) => ({ name: `${shown(x, 6)} m [${this.spec.unit}]`, values: Array.from(this.t, (_, i) => this.v[i * n + j]), single: true }))];
  }
}

function near(a, v) {
  const i = below(a, v);
  return i + 1 < a.length && Math.abs(a[i + 1] - v) < Math.abs(a[i] - v) ? i + 1 : i;
}
