// The table of scenarios: sorted, filtered, a hundred rows at a time.
const PAGE = 100;

class ScenarioTable {
  constructor(spec, parent, open) {
    this.columns = spec.columns.map(c => ({ ...c, values: arrays(c.a) }));
    this.n = spec.n; this.open = open;
    this.order = Array.from({ length: spec.n }, (_, i) => i);
    this.by = null; this.down = false; this.page = 0;
    this.filters = this.columns.map(() => null);
    const heads = this.columns.map((c, k) => el("th", { scope: "col" }, el("button", { type: "button", class: "sort", onclick: () => this.sort(k) }, c.name)));
    this.heads = heads;
    this.inputs = this.columns.map((c, k) => el("input", { type: "search", "aria-label": `Filter: ${c.name}`, placeholder: c.texts ? "text" : "> 0", oninput: e => this.filter(k, e.target.value) }));
    this.body = el("tbody");
    this.count = el("p", { class: "note", role: "status" });
    this.before = el("button", { type: "button", onclick: () => this.turn(-1) }, "‹ Previous");
    this.after = el("button", { type: "button", onclick: () => this.turn(1) }, "Next ›");
    parent.append(
      el("div", { class: "controls" }, this.before, this.after, el("button", { type: "button", onclick: () => download(this.csv(), fileName("scenarios", "csv"), "text/csv") }, "CSV of these rows")),
      el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Table of scenarios" },
        el("table", { class: "scenarios" }, el("thead", {}, el("tr", {}, ...heads), el("tr", {}, ...this.inputs.map(i => el("td", {}, i)))), this.body)),
      this.count, el("p", { class: "note" }, spec.note));
    this.update();
  }

  text(c, i) { return c.texts ? c.texts[c.values[i]] : c.a === this.columns[0].a ? String(c.values[i]) : shown(c.values[i], 4); }

  sort(k) {
    this.down = this.by === k ? !this.down : !this.columns[k].texts && k > 0;
    this.by = k;
    this.heads.forEach((h, i) => { if (i === k) h.setAttribute("aria-sort", this.down ? "descending" : "ascending"); else h.removeAttribute("aria-sort"); });
    this.update();
  }

  // Words of a filter as a test of a row; null for none.
  filter(k, words) {
    const c = this.columns[k], text = words.trim().toLowerCase().replace("−", "-");
    this.filters[k] = null;
    if (text && c.texts) { const hit = c.texts.map(t => t.toLowerCase().includes(text)); this.filters[k] = i => hit[c.values[i]]; }
    else if (text) {
      const range = text.match(/^(-?[\d.e]+)\s*\.\.\s*(-?[\d.e]+)$/), one = text.match(/^([<>]=?|=)?\s*(-?[\d.]+(?:e-?\d+)?)$/);
      if (range) { const a = Number(range[1]), b = Number(range[2]); this.filters[k] = i => c.values[i] >= a && c.values[i] <= b; }
      else if (one) {
        const v = Number(one[2]), near_ = 5e-4 * Math.abs(v);
        const test = { ">": x => x > v, ">=": x => x >= v, "<": x => x < v, "<=": x => x <= v }[one[1]] || (x => Math.abs(x - v) <= near_);
        this.filters[k] = i => test(c.values[i]);
      } else this.filters[k] = () => false;
    }
    this.page = 0;
    this.update();
  }

  update() {
    const tests = this.filters.filter(Boolean);
    this.rows = [];
    for (let i = 0; i < this.n; i++) if (tests.every(t => t(i))) this.rows.push(i);
    if (this.by != null) {
      const c = this.columns[this.by], sign = this.down ? -1 : 1;
      const rank = c.texts ? (() => { const sorted = c.texts.map((t, i) => [t, i]).sort((p, q) => p[0].localeCompare(q[0])), r = []; sorted.forEach(([, i], k) => { r[i] = k; }); return i => r[c.values[i]]; })() : i => c.values[i];
      this.rows.sort((p, q) => { const a = rank(p), b = rank(q); return Number.isNaN(a) ? (Number.isNaN(b) ? 0 : 1) : Number.isNaN(b) ? -1 : sign * (a - b); });
    }
    this.show();
  }

  turn(by) { this.page += by; this.show(); }

  show() {
    const last = Math.max(0, Math.ceil(this.rows.length / PAGE) - 1);
    this.page = Math.min(Math.max(this.page, 0), last);
    const begin = this.page * PAGE, some = this.rows.slice(begin, begin + PAGE);
    this.body.replaceChildren(...some.map(i => el("tr", {}, ...this.columns.map((c, k) => k === 0
      ? el("td", { class: "n" }, el("button", { type: "button", class: "link", "aria-label": `Open scenario ${c.values[i]}`, onclick: () => this.open(c.values[i]) }, String(c.values[i])))
      : el("td", { class: c.texts ? "" : "n" }, this.text(c, i))))));
    this.before.disabled = this.page === 0; this.after.disabled = this.page === last;
    this.count.textContent = this.rows.length ? `${begin + 1} to ${begin + some.length} of ${this.rows.length} scenarios${this.rows.length < this.n ? `, of ${this.n} in all` : ""}` : `none of ${this.n} scenarios`;
  }

  row(id) { const at = this.columns[0].values.indexOf(id); return at < 0 ? [] : this.columns.map(c => [c.name, this.text(c, at)]); }

  csv() { return [this.columns.map(c => quoted(c.name)).join(","), ...this.rows.map(i => this.columns.map(c => c.texts ? quoted(c.texts[c.values[i]]) : Number.isNaN(c.values[i]) ? "" : Number(c.values[i].toPrecision(7))).join(","))].join("\r\n") + "\r\n"; }
}

// Values by row and speed, in colors; a click opens the scenario.
class HeatMap {
  constructor(spec, parent, open) {
    Object.assign(this, { spec, open, which: 0, x: arrays(spec.x) });
    this.at = null;
    const choice = el("select", { id: "heat-choice", onchange: e => { this.which = Number(e.target.value); this.at = null; this.tip.hidden = true; this.draw(); } }, ...spec.maps.map((m, i) => el("option", { value: i }, `${m.title} [${m.unit}]`)));
    this.frame = el("div", { class: "canvas", tabindex: "0", role: "group", "aria-roledescription": "map", "aria-label": `Values by ${spec.label} and speed. Arrow keys move the cell that is read, Enter opens its scenario.` });
    this.canvas = el("canvas");
    this.tip = el("div", { class: "tip", hidden: true });
    this.frame.append(this.canvas, this.tip);
    const box = el("div", { class: "plot", id: "heat" }, el("div", { class: "plot-head" }, el("label", {}, "Quantity ", choice),
      el("div", { class: "tools" }, el("button", { type: "button", "aria-label": "Download the map as CSV", onclick: () => download(this.csv(), fileName("map", "csv"), "text/csv") }, "CSV"))), this.frame);
    box.map = this;
    parent.append(box);
    const cell = e => { const r = this.canvas.getBoundingClientRect(); return this.cell(e.clientX - r.left, e.clientY - r.top); };
    this.frame.addEventListener("pointermove", e => this.pick(cell(e)));
    this.frame.addEventListener("pointerleave", () => this.pick(null));
    this.frame.addEventListener("click", e => { const c = cell(e); if (c) this.go(c); });
    this.frame.addEventListener("keydown", e => {
      const by = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[e.key];
      if (e.key === "Enter" && this.at) this.go(this.at);
      else if (!by) return;
      else { const [i, j] = this.at || [0, 0]; this.pick([Math.min(spec.rows.length - 1, Math.max(0, i + by[0])), Math.min(this.x.length - 1, Math.max(0, j + by[1]))]); say(this.tip.textContent); }
      e.preventDefault();
    });
    repaints.push(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.frame);
    this.draw();
  }

  table() { const m = this.spec.maps[this.which]; return { m, v: arrays(m.a), ids: arrays(m.ids) }; }

  draw() {
    const { m, v } = this.table(), W = Math.max(this.frame.clientWidth, 240), rows = this.spec.rows.length, px = devicePixelRatio || 1, ctx = this.canvas.getContext("2d");
    const L = Math.min(220, 0.34 * W), R = 78, T = 6, B = 40, H = T + B + rows * Math.max(14, Math.min(34, 300 / rows));
    this.canvas.width = Math.round(W * px); this.canvas.height = Math.round(H * px); this.canvas.style.width = `${W}px`; this.canvas.style.height = `${H}px`;
    ctx.setTransform(px, 0, 0, px, 0, 0); ctx.clearRect(0, 0, W, H);
    let low = Infinity, high = -Infinity;
    for (const a of v) if (Number.isFinite(a)) { low = Math.min(low, a); high = Math.max(high, a); }
    const w = (W - L - R) / this.x.length, h = (H - T - B) / rows, share = a => high > low ? (a - low) / (high - low) : 0.5;
    for (let i = 0; i < rows; i++) for (let j = 0; j < this.x.length; j++) {
      const a = v[i * this.x.length + j];
      ctx.fillStyle = Number.isFinite(a) ? `rgb(${mixed(SEQUENTIAL, share(a)).map(Math.round).join(",")})` : css("--grid");
      ctx.fillRect(L + j * w, T + i * h, Math.ceil(w) , Math.ceil(h));
    }
    ctx.fillStyle = css("--ink"); ctx.font = "12px system-ui, sans-serif"; ctx.textAlign = "right"; ctx.textBaseline = "middle";
    this.spec.rows.forEach((name, i) => { let text = name; while (text.length > 4 && ctx.measureText(text).width > L - 12) text = text.slice(0, -2) + "…"; ctx.fillText(text, L - 8, T + (i + 0.5) * h); });
    ctx.textAlign = "center"; ctx.textBaseline = "alphabetic";
    const n = this.x.length, step = Math.max(1, Math.ceil(n / Math.max(2, (W - L - R) / 54)));
    for (let j = 0; j < n; j += step) ctx.fillText(shown(this.x[j], 4).replace(/\.?0+$/, ""), L + (j + 0.5) * w, H - B + 15);
    ctx.fillText("Speed [km/h]", (L + W - R) / 2, H - 6);
    if (this.at) { ctx.strokeStyle = css("--focus"); ctx.lineWidth = 3; ctx.strokeRect(L + this.at[1] * w, T + this.at[0] * h, w, h); }
    const bx = W - R + 14, bh = H - T - B;
    for (let k = 0; k < bh; k++) { ctx.fillStyle = `rgb(${mixed(SEQUENTIAL, 1 - k / bh).map(Math.round).join(",")})`; ctx.fillRect(bx, T + k, 12, 1.5); }
    ctx.fillStyle = css("--ink"); ctx.textAlign = "left";
    ctx.fillText(shown(high, 3), bx + 16, T + 10); ctx.fillText(shown(low, 3), bx + 16, T + bh);
    this.box = { L, T, w, h, rows };
  }

  cell(left, top) { const { L, T, w, h, rows } = this.box, j = Math.floor((left - L) / w), i = Math.floor((top - T) / h); return i >= 0 && i < rows && j >= 0 && j < this.x.length ? [i, j] : null; }

  pick(at) {
    this.at = at; this.tip.hidden = !at; this.draw();
    if (!at) return;
    const { m, v } = this.table(), [i, j] = at, { L, T, w, h } = this.box;
    this.tip.textContent = `${this.spec.rows[i]}, ${shown(this.x[j], 4)} km/h: ${shown(v[i * this.x.length + j])} ${m.unit}`;
    const left = L + (j + 1) * w, right = left > this.frame.clientWidth / 2;
    this.tip.style.left = right ? "" : `${left + 6}px`; this.tip.style.right = right ? `${this.frame.clientWidth - left + w + 6}px` : ""; this.tip.style.top = `${Math.max(0, T + i * h - 4)}px`;
  }

  go([i, j]) { const id = this.table().ids[i * this.x.length + j]; if (id >= 0) this.open(id); }

  csv() { const { m, v } = this.table(), n = this.x.length; return csv([{ name: "Speed [km/h]", values: this.x }, ...this.spec.rows.map((name, i) => ({ name: `${name} [${m.unit}]`, values: v.slice(i * n, (i + 1) * n), single: true }))]); }
}
