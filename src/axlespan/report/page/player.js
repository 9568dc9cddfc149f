// The clock of the animation and its controls; a view draws the scene at a time.
const NICE = [1, 2, 5];
const nice = v => { if (!(v > 0)) return 1; const p = 10 ** Math.floor(Math.log10(v)); return p * NICE.filter(m => m * p <= v).pop(); };

class Scene {
  constructor(spec) {
    this.ends = spec.ends; this.units = spec.units; this.supports = spec.supports; this.legs = spec.legs; this.line = spec.line;
    this.time = arrays(spec.t);
    this.trains = spec.trains.map(t => ({ at: arrays(t.head), way: t.direction }));
    this.profile = spec.profile ? { ...spec.profile, r: arrays(spec.profile.r) } : null;
    this.begin = this.time[0]; this.end = this.time[this.time.length - 1];
    this.lineX = spec.line ? arrays(spec.line.x) : null;
    this.lineW = spec.line ? restored(spec.line.w) : null;
    this.ratioOf = spec.ratio ? restored(spec.ratio) : null;
    this.contacts = spec.ratio ? spec.ratio.shape[1] : 0;
    this.columns = {};
    for (const kind of ["z", "pitch"]) if (spec.moves[kind]) {
      const { names, values } = spec.moves[kind], table = restored(values);
      names.forEach((name, k) => { this.columns[name] = { table, k, n: names.length }; });
    }
    this.row = 0; this.part = 0;
  }
  go(t) {
    this.now = Math.min(Math.max(t, this.begin), this.end);
    this.row = Math.min(below(this.time, this.now), this.time.length - 2);
    this.part = (this.now - this.time[this.row]) / (this.time[this.row + 1] - this.time[this.row]);
  }
  between(table, n, k) { const a = table[this.row * n + k], b = table[(this.row + 1) * n + k]; return a + this.part * (b - a); }
  head(train = 0) { return this.between(this.trains[train].at, 1, 0); }
  // Position of what is so far behind the head of its train.
  place(unit, behind) { return this.head(unit.train) - this.trains[unit.train].way * behind; }
  r(s) {
    const p = this.profile;
    if (!p) return 0;
    const k = (s - p.from) / p.step, i = Math.floor(k);
    return i < 0 || i + 1 >= p.r.length ? 0 : p.r[i] + (k - i) * (p.r[i + 1] - p.r[i]);
  }
  dof(name) { const c = this.columns[name]; return c ? this.between(c.table, c.n, c.k) : null; }
  ratio(contact) { return this.ratioOf ? this.between(this.ratioOf, this.contacts, contact) : NaN; }
  w(s) {
    const x = this.lineX;
    if (!x || s < x[0] || s > x[x.length - 1]) return 0;
    const n = x.length, i = Math.min(below(x, s), n - 2), f = (s - x[i]) / (x[i + 1] - x[i]);
    return (1 - f) * this.between(this.lineW, n, i) + f * this.between(this.lineW, n, i + 1);
  }
  // Vertical motion of a wheel: its own, or that of the line under it.
  wheel([, behind, dof], unit) { const z = dof ? this.dof(dof) : null; if (z != null) return z; const s = this.place(unit, behind); return this.w(s) + this.r(s); }
  tilt(name) { return this.dof(`${name}.pitch`) ?? this.dof(`${name}.ry`) ?? 0; }
}

// Colors of Q/Q0: unloaded is orange to red, loaded more is blue.
function loadColor(ratio) {
  if (!Number.isFinite(ratio)) return css("--wheel");
  const stops = [[178, 24, 43], [239, 138, 98], [150, 150, 150], [103, 169, 207], [33, 102, 172]];
  return `rgb(${mixed(stops, ratio / 2).map(Math.round).join(",")})`;
}

function player(spec, space, parent) {
  const scene = new Scene(spec), still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const length = spec.ends[1] - spec.ends[0];
  const most = Math.max(spec.line ? spec.line.most : 0, space && space.motion ? space.motion.most : 0);
  // Enlarged as far as a deflection shows well and no vehicle flies.
  const natural = most > 0 ? Math.max(1, nice(Math.min(0.04 * length / most, spec.most > 0 ? 1.3 / spec.most : Infinity))) : 1;
  const state = { playing: false, speed: still ? 0.25 : 1, factor: natural, view: "bridge", color: "size" };
  const stage = el("div", { id: "stage", tabindex: "0", role: "img", "aria-label": "The train on the deflecting structure. Space plays and pauses, arrows step in time." });
  const play = el("button", { type: "button", id: "play", onclick: () => toggle() }, "▶ Play");
  const scrub = el("input", { type: "range", id: "scrub", min: "0", max: "1000", step: "1", value: "0", "aria-label": "Time" });
  const speed = el("select", { id: "speed" }, ...[0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 4].map(v => el("option", { value: v, selected: v === state.speed }, `${v} ×`)));
  const slider = el("input", { type: "range", id: "exaggeration", min: "0", max: String(Math.log10(Math.max(natural * 20, 10))), step: "0.01", value: String(Math.log10(natural)) });
  const factor = el("output", { for: "exaggeration" });
  const view = el("select", { id: "view" }, el("option", { value: "bridge" }, "whole structure"), el("option", { value: "follow" }, "follow the first vehicle"), el("option", { value: "train" }, "whole train"));
  const dimension = el("select", { id: "dimension" }, el("option", { value: "3" }, "in space"), el("option", { value: "2" }, "from the side"));
  const coloring = el("select", { id: "coloring" });
  const readout = el("div", { class: "readout" });
  const controls = el("div", { class: "controls" }, play, scrub,
    el("label", {}, "Speed", speed), el("label", {}, "Deflections enlarged", slider, factor), el("label", { id: "view-label" }, "Show", view));
  const legend = el("div", { class: "controls" });
  parent.append(stage, controls, readout, legend, ...spec.notes.map(n => el("p", { class: "note" }, n)));
  legend.append(scaleBar("Wheel force over static force", s => loadColor(2 * s), ["0", "1", "2"]));

  let flat = null, solid = null, current = null;
  const flatView = () => flat || (flat = new FlatView(scene, stage, state));
  if (space) {
    try { solid = new SpaceView(scene, space, stage, state); } catch (error) {
      parent.append(el("p", { class: "note" }, "This browser cannot draw in space (WebGL), so the crossing is shown from the side."));
    }
  }
  if (solid) {
    controls.append(el("label", {}, "View", dimension));
    coloring.append(...solid.colorings().map(([value, words]) => el("option", { value }, words)));
    state.color = coloring.value;
    controls.append(el("label", {}, "Color", coloring));
    const bar = scaleBar("", s => `rgb(${mixed(SEQUENTIAL, s).map(Math.round).join(",")})`, ["", "", ""]);
    legend.append(bar);
    solid.legend = bar;
    parent.append(el("p", { class: "note" }, solid.words() + " Drag to turn, wheel or pinch to zoom; with the keyboard: A, D, W, S turn, + and − zoom."));
  }
  const choose = which => {
    current = which;
    for (const v of [flat, solid]) if (v) v.canvas.hidden = v !== which;
    byId("view-label").hidden = which === solid;
    coloring.disabled = which !== solid;
    show();
  };
  const words = t => {
    const head = scene.head();
    let worst = null;
    if (scene.ratioOf) for (let i = 0; i < scene.contacts; i++) { const r = scene.ratio(i); if (worst == null || r < worst) worst = r; }
    const parts = [["Time", `${t.toFixed(3)} s`], ["First wheel", `at ${head.toFixed(2)} m`]];
    if (scene.lineX) { let low = 0; for (const x of scene.lineX) low = Math.min(low, scene.w(x)); parts.push(["Largest deflection now", `${shown(-1e3 * low, 3)} mm`]); }
    if (worst != null && Number.isFinite(worst)) parts.push(["Least loaded wheel", `${(100 * worst).toFixed(1)} % of static`]);
    readout.replaceChildren(...parts.map(([a, b]) => el("span", {}, `${a} `, el("b", {}, b))));
  };
  function show() {
    scene.go(state.t);
    if (current) current.draw();
    words(scene.now);
    const share = (scene.now - scene.begin) / (scene.end - scene.begin);
    scrub.value = String(Math.round(1000 * share));
    scrub.setAttribute("aria-valuetext", `${scene.now.toFixed(3)} seconds`);
  }
  const set = (t, tell = true) => { state.t = Math.min(Math.max(t, scene.begin), scene.end); show(); if (tell) played.tell(scene.now); };
  let last = 0;
  function tick(stamp) {
    if (!state.playing) return;
    const dt = last ? Math.min((stamp - last) / 1000, 0.1) : 0;
    last = stamp;
    let t = state.t + dt * state.speed;
    if (t >= scene.end) { t = scene.end; stop(); }
    set(t);
    if (state.playing) requestAnimationFrame(tick);
  }
  function stop() { state.playing = false; play.textContent = "▶ Play"; }
  function toggle() {
    if (state.playing) return stop();
    if (state.t >= scene.end) state.t = scene.begin;
    state.playing = true; last = 0; play.textContent = "❚❚ Pause";
    requestAnimationFrame(tick);
  }
  scrub.addEventListener("input", () => { stop(); set(scene.begin + scrub.value / 1000 * (scene.end - scene.begin)); });
  speed.addEventListener("change", () => { state.speed = Number(speed.value); });
  const enlarge = () => { const v = 10 ** Number(slider.value); state.factor = v < 10 ? Math.round(v * 10) / 10 : Number(v.toPrecision(2)); factor.textContent = `${state.factor} ×`; slider.setAttribute("aria-valuetext", `${state.factor} times`); show(); };
  slider.addEventListener("input", enlarge);
  slider.setAttribute("aria-label", "Deflections enlarged");
  view.addEventListener("change", () => { state.view = view.value; show(); });
  dimension.addEventListener("change", () => choose(dimension.value === "3" ? solid : flatView()));
  coloring.addEventListener("change", () => { state.color = coloring.value; show(); });
  stage.addEventListener("keydown", e => {
    const step = (scene.end - scene.begin) / (e.shiftKey ? 40 : 400);
    if (e.key === " ") toggle();
    else if (e.key === "ArrowRight") { stop(); set(state.t + step); }
    else if (e.key === "ArrowLeft") { stop(); set(state.t - step); }
    else if (e.key === "Home") { stop(); set(scene.begin); }
    else if (e.key === "End") { stop(); set(scene.end); }
    else if (!(current && current.key && current.key(e.key))) return;
    e.preventDefault();
    say(readout.textContent);
  });
  repaints.push(show);
  new ResizeObserver(() => { if (current) { current.fit(); show(); } }).observe(stage);
  // It opens on the moment of the largest deflection, which says more than an empty bridge.
  state.t = scene.begin;
  if (scene.lineW) {
    let k = 0;
    for (let i = 0; i < scene.lineW.length; i++) if (scene.lineW[i] < scene.lineW[k]) k = i;
    state.t = scene.time[Math.floor(k / scene.lineX.length)];
  }
  choose(solid || flatView());
  enlarge();
  set(state.t);
  parent.player = { scene, state, set, toggle, view: () => current };
}

function scaleBar(label, color, marks) {
  const canvas = el("canvas", { width: 180, height: 14, "aria-hidden": "true" }), ctx = canvas.getContext("2d");
  const paint = () => { for (let i = 0; i < 180; i++) { ctx.fillStyle = color(i / 179); ctx.fillRect(i, 0, 1, 14); } };
  paint();
  const text = el("span", {}, label), ends = marks.map(m => el("span", {}, m));
  const bar = el("span", { class: "scale" }, text, ends[0], canvas, ends[2]);
  if (marks[1]) canvas.title = `the middle is ${marks[1]}`;
  bar.set = (words, low, high) => { text.textContent = words; ends[0].textContent = low; ends[2].textContent = high; };
  return bar;
}
