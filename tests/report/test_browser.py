# ruff: noqa: E501
"""The pages in a real browser: they draw, react, ask nobody, and show the numbers of result.nc."""

from __future__ import annotations

import csv
import io as text_io
import json
import re

import numpy as np
import pytest

from axlespan.io.results import read_result

NOT_BLANK = """c => { const x = c.getContext('2d'), d = x.getImageData(0, 0, c.width, c.height).data, seen = new Set();
  for (let i = 0; i < d.length; i += 4) { if (d[i + 3]) seen.add((d[i] << 16) | (d[i + 1] << 8) | d[i + 2]); if (seen.size > 3) return true; } return false; }"""
LUMINANCE = """() => { const rgb = s => s.match(/[\\d.]+/g).slice(0, 3).map(Number);
  const light = c => { const [r, g, b] = rgb(c).map(v => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  const ground = e => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor; if (!/, 0\\)$|transparent/.test(c)) return c; } return 'rgb(255,255,255)'; };
  const found = [];
  for (const e of document.querySelectorAll('h1,h2,h3,p,a,td,th,button,summary,.badge,.what,.value,.where,.hint,.note,dt,dd,.at,label,caption')) {
    if (!e.textContent.trim() || !e.getClientRects().length) continue;
    const a = light(getComputedStyle(e).color), b = light(ground(e));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) found.push(`${e.tagName}.${e.className}: ${ratio.toFixed(2)}`);
  } return [...new Set(found)]; }"""


def drawn(reader):
    """Canvases of plots and maps that show something, and all of them."""
    canvases = reader.page.query_selector_all(".plots canvas")
    return [canvas.evaluate(NOT_BLANK) for canvas in canvases if canvas.is_visible()]


def test_the_demo_opens_and_draws_everything(beam, read):
    page = beam / "report.html"
    assert page.stat().st_size < 3e6
    reader = read(beam)
    took = reader.run("performance.timing.domContentLoadedEventEnd - performance.timing.navigationStart")
    assert took < 2000.0  # ms, on a loaded machine
    found = drawn(reader)
    assert len(found) >= 10 and all(found)
    titles = reader.run("[...document.querySelectorAll('#contents a')].map(a => a.textContent)")
    assert titles == [
        "Case",
        "Animation",
        "Verdicts",
        "Histories",
        "Maps",
        "Contact forces",
        "Spectra",
        "Extremes",
    ]
    assert reader.page.query_selector("#stage canvas").evaluate(NOT_BLANK)
    assert (
        reader.run("document.querySelectorAll('.sketch rect, .sketch circle').length") == 3
    )  # deck, body, wheel


def test_histories_are_those_of_the_result(beam, read):
    """CSV of a plot against result.nc, and so for every curve on the page."""
    result = read_result(beam / "result.nc")
    reader = read(beam)
    with reader.page.expect_download() as caught:
        reader.page.click("#plot-displacement button:has-text('CSV')")
    with open(caught.value.path(), encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["Time [s]", "midspan [mm]"]
    table = np.array(rows[1:], dtype=float)
    np.testing.assert_allclose(table[:, 0], result.time, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(
        table[:, 1], 1e3 * result.at("sensor_displacement", "midspan"), rtol=1e-6, atol=1e-12
    )
    for key, quantity, name, factor in (
        ("acceleration", "sensor_acceleration", "midspan", 1.0),
        ("contact", "contact_force", "1.1", 1e-3),
        ("body-a", "vehicle_acceleration", "1.body.z", 1.0),
        ("reaction", "support_reaction", "left.z", 1e-3),
    ):
        values = reader.run(f"Array.from(document.getElementById('plot-{key}').plot.u.data[1])")
        np.testing.assert_allclose(values, factor * result.at(quantity, name), rtol=1e-6, atol=1e-9)
    cell = reader.page.query_selector("#extremes td[data-value]")
    assert float(cell.get_attribute("data-value")) == result.at("sensor_displacement", "midspan").min()


def test_hover_reads_values_and_is_shared(beam, read):
    result = read_result(beam / "result.nc")
    reader = read(beam)
    over = reader.page.query_selector("#plot-displacement .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    reader.page.mouse.move(box["x"] + 0.4123 * box["width"], box["y"] + 0.5 * box["height"])
    time = reader.run("(p => p.u.data[0][p.u.cursor.idx])(document.getElementById('plot-displacement').plot)")
    row = int(np.abs(result.time - time).argmin())
    text = reader.page.inner_text("#plot-displacement .curves output").replace("−", "-")
    assert float(text) == pytest.approx(1e3 * result.at("sensor_displacement", "midspan")[row], rel=1e-4)
    other = reader.run("(p => p.u.data[0][p.u.cursor.idx])(document.getElementById('plot-contact').plot)")
    assert other == time
    force = float(reader.page.inner_text("#plot-contact .curves output"))
    assert force == pytest.approx(1e-3 * result.at("contact_force", "1.1")[row], rel=1e-4)


def test_zoom_by_dragging_and_by_keys(beam, read):
    reader = read(beam)
    over = reader.page.query_selector("#plot-acceleration .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    reader.page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 50)
    reader.page.mouse.down()
    reader.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 50, steps=4)
    reader.page.mouse.up()
    range_ = "(p => [p.u.scales.x.min, p.u.scales.x.max])(document.getElementById('plot-%s').plot)"
    begin, end = reader.run(range_ % "acceleration")
    assert begin == pytest.approx(0.225, abs=0.005) and end == pytest.approx(0.45, abs=0.005)
    assert reader.run(range_ % "contact") == pytest.approx([begin, end])
    reader.page.focus("#plot-contact .canvas")
    reader.page.keyboard.press("0")
    assert reader.run(range_ % "acceleration") == pytest.approx([0.0, 0.9])
    reader.page.keyboard.press("+")
    begin, end = reader.run(range_ % "contact")
    assert end - begin == pytest.approx(0.54, rel=0.01)
    reader.page.keyboard.press("ArrowRight")
    said = reader.page.inner_text("#said")
    assert re.match(r"wheel 1\.1 5\d\.\d+; Time 0\.\d+ s, values in kN", said)


def test_map_reads_the_values_along_the_line(beam, read):
    result = read_result(beam / "result.nc")
    reader = read(beam)
    reader.page.focus("#map-line_displacement .canvas")
    for _ in range(3):
        reader.page.keyboard.press("Shift+ArrowLeft")
    text = reader.page.inner_text("#map-line_displacement .tip").replace("−", "-")
    value, place, time = map(float, re.match(r"(\S+) mm at (\S+) m, (\S+) s", text).groups())
    column = int(np.abs(result.line_position - place).argmin())
    near = np.abs(result.time - time) < 2.2e-3  # half a cell and a step
    values = 1e3 * result.line_displacement[near, column]
    assert np.abs(values - value).min() < 2e-3 * np.abs(result.line_displacement).max() * 1e3
    painted = reader.run(
        "(m => [m.v.length, m.largest])(document.getElementById('map-line_displacement').map)"
    )
    assert painted[1] == pytest.approx(1e3 * np.abs(result.line_displacement).max(), rel=1e-4)


def test_animation_plays_and_scrubs(beam, read):
    """The scene at a time is that of the result: wheel, body and deflection."""
    result = read_result(beam / "result.nc")
    reader = read(beam)
    reader.run(
        """() => { const s = document.getElementById('scrub'); s.value = 500; s.dispatchEvent(new Event('input')); }"""
    )
    state = reader.run(
        """() => { const { scene } = document.getElementById('player').player;
        return { t: scene.now, head: scene.head(), body: scene.dof('1.body.z'), w: scene.w(12.5), ratio: scene.ratio(0) }; }"""
    )
    row = int(np.abs(result.time - state["t"]).argmin())
    assert state["t"] == pytest.approx(0.45, abs=1e-9)
    assert state["head"] == pytest.approx(result.contact_position[row, 0], abs=1e-9)
    assert state["body"] == pytest.approx(result.at("vehicle_displacement", "1.body.z")[row], abs=1e-7)
    assert state["w"] == pytest.approx(result.at("sensor_displacement", "midspan")[row], abs=1e-7)
    assert state["ratio"] == pytest.approx(result.contact_force[row, 0] / 56407.5, abs=1e-5)
    picture = "document.querySelector('#stage canvas').toDataURL()"
    before = reader.run(picture)
    reader.page.focus("#stage")
    reader.page.keyboard.press("Space")
    reader.wait("document.getElementById('player').player.scene.now > 0.5")
    reader.page.keyboard.press("Space")
    assert reader.page.inner_text("#play") == "▶ Play"
    assert reader.run(picture) != before
    stopped = reader.run("document.getElementById('player').player.scene.now")
    reader.page.keyboard.press("ArrowLeft")
    assert reader.run("document.getElementById('player').player.scene.now") == pytest.approx(
        stopped - 0.9 / 400
    )
    reader.run(
        """() => { const s = document.getElementById('exaggeration'); s.value = 1; s.dispatchEvent(new Event('input')); }"""
    )
    assert reader.run("document.getElementById('player').player.state.factor") == 10


def test_long_trains_are_thinned_without_losing_a_peak(train, read):
    result = read_result(train / "result.nc")
    reader = read(train)
    assert (train / "report.html").stat().st_size < 3e6
    peak = reader.run(
        "(d => [Math.min(...d[1]), d[0].length])(document.getElementById('plot-displacement').plot.u.data)"
    )
    assert peak[0] == pytest.approx(1e3 * result.sensor_displacement.min(), rel=1e-6)
    assert 1000 < peak[1] <= 6000 < len(result.time)
    names = reader.run("document.getElementById('plot-contact').plot.series.map(s => s.name)")
    assert len(names) == 24 and names[0] == "wheel 1.1" and names[-1] == "wheel 30.1"
    note = reader.page.inner_text("#plot-contact p.note")
    assert "24 of 30 curves" in note and "of 7001 times are shown, with every peak" in note
    buttons = reader.page.query_selector_all("#plot-contact .curves button")
    states = [button.get_attribute("aria-pressed") for button in buttons]
    assert states.count("true") == 6
    hidden = states.index("false")
    buttons[hidden].press("Enter")
    assert reader.run(f"document.getElementById('plot-contact').plot.u.series[{hidden + 1}].show") is True


def test_spectrum_switches_to_density(beam, read):
    reader = read(beam)
    data = "(d => [d[0][1], Math.max(...d[1])])(document.getElementById('plot-spectrum-acceleration').plot.u.data)"
    step, amplitude = reader.run(data)
    reader.page.check("input[value=psd]")
    density = reader.run(data)[1]
    # Hann: noise bandwidth of 1.5 bins
    assert density == pytest.approx(amplitude**2 / (2.0 * step * 1.5), rel=1e-5)


def test_solids_move_in_space(solid, read):
    result = read_result(solid / "result.nc")
    reader = read(solid)
    spots = reader.run("""() => { const p = document.getElementById('player').player; p.set(0.2);
      const v = p.view(); let low = 0; for (let i = 2; i < v.moved.length; i += 3) low = Math.min(low, v.moved[i]);
      return { low, colors: new Set(Array.from(v.colors.array, c => Math.round(50 * c))).size, space: !!v.renderer,
               options: [...document.querySelectorAll('#coloring option')].map(o => o.value), triangles: v.faces.length / 3 }; }""")
    vertical = [i for i, name in enumerate(result.fields.dof_names) if name.endswith(".z")]
    at = int(np.abs(result.fields.times - 0.2).argmin())
    assert result.fields.times[at] == pytest.approx(0.2)
    assert spots["space"] and spots["triangles"] == 4 * (24 * 2 * 2 + 2 * 2)
    assert spots["low"] == pytest.approx(result.fields.displacement[at][vertical].min(), rel=1e-3)
    assert spots["options"] == ["stress", "size", "down"] and spots["colors"] > 10
    shot = reader.page.query_selector("#stage").screenshot()
    assert len(set(pixels(shot))) > 30  # a picture with shades, not a blank stage
    reader.page.select_option("#dimension", "2")
    visible = reader.run("[...document.querySelectorAll('#stage canvas')].map(c => !c.hidden)")
    assert visible == [False, True]
    assert reader.page.query_selector_all("#stage canvas")[1].evaluate(NOT_BLANK)


def pixels(png):
    from PIL import Image

    small = np.asarray(Image.open(text_io.BytesIO(png)).convert("RGB").resize((120, 60)))
    return map(tuple, small.reshape(-1, 3).tolist())


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrast_by_wcag(beam, read, scheme):
    """At least 4.5 to 1 for text (WCAG 2.2, 1.4.3)."""
    reader = read(beam, color_scheme=scheme)
    reader.page.click("details.values summary")
    assert reader.run("document.documentElement.dataset.theme") == scheme
    assert reader.run(LUMINANCE) == []


def test_theme_button(beam, read):
    reader = read(beam, color_scheme="light")
    for expected in ("light", "dark", "light"):
        reader.page.click("#theme")
        assert reader.run("document.documentElement.dataset.theme") == expected
    assert reader.page.inner_text("#theme") == "Theme: system"


def test_phone_does_not_scroll_sideways(solid, read):
    reader = read(
        solid, viewport={"width": 360, "height": 740}, device_scale_factor=2, is_mobile=True, has_touch=True
    )
    assert reader.run("document.documentElement.scrollWidth") <= 360
    assert all(drawn(reader))


def test_print_is_light_and_without_controls(beam, read, tmp_path):
    reader = read(beam, color_scheme="dark")
    reader.page.emulate_media(media="print")
    reader.wait("document.documentElement.dataset.theme === 'light'")
    assert not reader.page.is_visible(".controls") and not reader.page.is_visible("nav")
    assert reader.page.is_visible("#plot-displacement canvas") and reader.page.is_visible("#stage canvas")
    assert len(reader.page.pdf(print_background=True)) > 50_000
    reader.page.emulate_media(media="screen")
    reader.wait("document.documentElement.dataset.theme === 'dark'")


def test_all_by_keyboard(beam, read):
    """Tab reaches every control in order, and shows where it is."""
    reader = read(beam)
    seen = []
    for _ in range(40):
        reader.page.keyboard.press("Tab")
        seen.append(
            reader.run(
                "(e => [e.id || e.className || e.tagName, getComputedStyle(e).outlineStyle])(document.activeElement)"
            )
        )
    names = [name for name, _ in seen]
    for name in (
        "skip",
        "theme",
        "print",
        "stage",
        "play",
        "scrub",
        "speed",
        "exaggeration",
        "view",
        "canvas",
    ):
        assert name in names, name
    assert all(style != "none" for _, style in seen)
    unnamed = reader.run(
        """[...document.querySelectorAll('button, input, select')].filter(e => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).length"""
    )
    assert unnamed == 0


def test_svg_of_a_plot_is_a_figure(beam, read):
    reader = read(beam)
    with reader.page.expect_download() as caught:
        reader.page.click("#plot-contact button:has-text('SVG')")
    text = caught.value.path().read_text(encoding="utf-8")
    assert caught.value.suggested_filename == "neves-et-al.-2012-example-3.1-contact.svg"
    assert text.startswith("<svg") and "Time [s]" in text and "wheel 1.1" in text
    assert text.count("L") > 800  # a line through 901 points
    with reader.page.expect_download() as caught:
        reader.page.click("#map-line_acceleration button:has-text('SVG')")
    assert "data:image/png;base64," in caught.value.path().read_text(encoding="utf-8")


def test_titles_cannot_break_out(copy, read):
    summary = json.loads((copy / "summary.json").read_text(encoding="utf-8"))
    summary["run"]["title"] = "</script><script>document.title='broken'</script><b>&"
    (copy / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    reader = read(copy)
    assert reader.page.inner_text("h1") == summary["run"]["title"]
    assert reader.page.title() == f"{summary['run']['title']} – axlespan report"
