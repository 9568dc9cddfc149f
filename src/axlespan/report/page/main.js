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
finish();
