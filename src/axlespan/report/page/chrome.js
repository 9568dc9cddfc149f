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

// The list of sections at the top; those without anything to see go.
function finish() {
  for (const section of document.querySelectorAll("main > section:not([hidden])"))
    if (section.querySelector("table, canvas, svg, dl, .cards > *, p:not(.hint)")) byId("contents").append(el("li", {}, el("a", { href: `#${section.id}` }, section.dataset.title)));
    else section.hidden = true;
  document.documentElement.dataset.ready = "yes";
}
