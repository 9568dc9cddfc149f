const table = content.table.n ? (reveal("scenarios"), new ScenarioTable(content.table, byId("scenario-table"), openScenario)) : null;

// Values and, where they came along, histories of one scenario.
function openScenario(id) {
  reveal("scenario");
  byId("scenario-title").textContent = `Scenario ${id}`;
  byId("scenario-about").replaceChildren(el("dl", { class: "about" }, ...(table ? table.row(id) : []).filter(([, v]) => v !== "" && v !== "–").flatMap(([k, v]) => [el("dt", {}, k), el("dd", {}, v)])));
  const plots = content.histories[id], box = byId("scenario-plots");
  box.replaceChildren();
  if (!plots) {
    const kept = Object.keys(content.histories).length;
    box.append(el("p", { class: "note" }, kept ? `The histories of this scenario are in the store, in histories/*.nc, but not on this page, which carries those of ${kept} scenarios, the worst first.` : "The study keeps no histories; write histories: {variables: [sensor_acceleration]} into its file to keep some."));
  } else for (const p of plots) plotBlock({ ...p, xLabel: "Time [s]", timed: true, xs: arrays(p.x), series: p.series.map((s, i) => ({ ...s, y: arrays(s.a), on: i < 6 })) }, box);
  byId("scenario-title").focus({ preventScroll: true });
  byId("scenario").scrollIntoView({ block: "start" });
  say(`Scenario ${id} is open`);
}

if (content.envelopes.length) {
  reveal("envelopes");
  for (const e of content.envelopes) guarded(e.title, () => plotBlock({
    ...e, xLabel: "Speed [km/h]", tables: true, dots: true, open: e !== content.envelopes[0] && content.envelopes.indexOf(e) > 3 ? false : undefined,
    series: e.series.map(s => ({ ...s, x: arrays(s.x), y: arrays(s.a), ids: arrays(s.ids) })),
    pick: (s, x) => { const i = near(s.x, x); openScenario(s.ids[i]); },
  }, byId("envelope-list")));
}
if (content.maps) { reveal("maps"); guarded("The map", () => new HeatMap(content.maps, byId("map-list"), openScenario)); }
if (content.exceedance.length) {
  reveal("distributions");
  for (const e of content.exceedance) guarded(e.title, () => plotBlock({ ...e, xs: arrays(e.x), series: e.series.map(s => ({ ...s, y: arrays(s.a) })) }, byId("distribution-list")));
}
finish();
