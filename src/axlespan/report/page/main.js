// --- light and dark
const dark = matchMedia("(prefers-color-scheme: dark)");
let theme = "system";
function paintTheme(forced) {
  document.documentElement.dataset.theme = forced || (theme === "system" ? (dark.matches ? "dark" : "light") : theme);
  byId("theme").textContent = `Theme: ${theme}`;
}
paintTheme();
byId("theme").addEventListener("click", () => { theme = { system: "light", light: "dark", dark: "system" }[theme]; paintTheme(); repaint(); });
dark.addEventListener("change", () => { paintTheme(); repaint(); });
const paper = matchMedia("print");
const toPaper = on => { paintTheme(on ? "light" : undefined); repaint(); };
addEventListener("beforeprint", () => toPaper(true));
addEventListener("afterprint", () => toPaper(false));
paper.addEventListener("change", () => toPaper(paper.matches));
byId("print").addEventListener("click", () => print());

// --- sections
const reveal = id => { byId(id).hidden = false; };
const guarded = (what, f) => { try { f(); } catch (error) { console.error(error); byId("main").prepend(el("aside", { class: "notices" }, `${what} cannot be drawn in this browser: ${error.message}`)); } };

if (content.scene) { reveal("crossing"); guarded("The animation", () => player(content.scene, content.space, byId("player"))); }
if (content.panels && content.panels.length) {
  reveal("histories");
  for (const p of content.panels) guarded(p.title, () => plotBlock({ ...p, xLabel: "Time [s]", timed: true, xs: arrays(p.x), series: p.series.map(s => ({ ...s, y: arrays(s.a) })) }, byId("panels")));
}
if (content.maps && content.maps.length) { reveal("maps"); for (const m of content.maps) guarded(m.title, () => new SpaceTime(m, byId("map-list"))); }
if (content.force) {
  const f = content.force;
  reveal("forces");
  guarded(f.title, () => plotBlock({
    ...f, xLabel: "Position of the wheel [m]", tables: true, marks: f.ends, levels: f.static,
    series: f.series.map(s => ({ ...s, x: arrays(s.x), y: arrays(s.a) })),
    band: f.band && { x: arrays(f.band.x), low: arrays(f.band.low), high: arrays(f.band.high) },
    note: [f.band ? "The band holds the forces of all wheels." : "", f.static.length ? "Dashed across: static force." : "", f.ends ? "Dashed upright: ends of the structure." : "", f.note].filter(Boolean).join(" "),
  }, byId("force-plot")));
}
if (content.spectra && content.spectra.length) {
  reveal("spectra");
  let kind = "a";
  const plots = content.spectra.map(s => plotBlock({
    ...s, xLabel: "Frequency [Hz]", window: [0, s.busy], xs: arrays(s.x), series: s.series.map(c => ({ ...c, y: arrays(c.a) })),
    unitOf: () => kind === "a" ? s.unit : `(${s.unit})²/Hz`,
    scaleOf: y => kind === "a" ? y : Float64Array.from(y, v => v * v * s.psd),
  }, byId("spectrum-list")).plot);
  for (const radio of document.getElementsByName("spectrum")) radio.addEventListener("change", () => { kind = radio.value; for (const p of plots) p.rebuild(); });
}
for (const section of document.querySelectorAll("main > section:not([hidden])"))
  if (section.querySelector("table, canvas, svg, dl, .cards > *, p:not(.hint)")) byId("contents").append(el("li", {}, el("a", { href: `#${section.id}` }, section.dataset.title)));
  else section.hidden = true;
document.documentElement.dataset.ready = "yes";
