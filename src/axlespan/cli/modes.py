"""``axlespan modes``: natural frequencies and what each mode takes part in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from axlespan.cli.folder import check_folder, publish, staged
from axlespan.cli.messages import DONE, FAILED, refuse, say, warn
from axlespan.errors import AnalysisError, InputError, Place
from axlespan.io.paraview import write_modes
from axlespan.io.strict_json import to_json
from axlespan.irregularity import spectrum_names
from axlespan.linalg.factor import NotPositiveDefinite
from axlespan.model.modal import SystemModes, modes_of
from axlespan.running.structure import Structure
from axlespan.study.build import build
from axlespan.study.loader import load_case
from axlespan.study.sweep.spec import is_study_file

#: Version of the layout of modes.json.
FORMAT_VERSION = 1

# Figures in space are drawn for so many modes.
_PICTURES = 10


def show_modes(case: Path, number: int | None, output: Path | None, *, force: bool) -> int:
    """Compute the modes of a case's structure, print and write them; the exit code."""
    try:
        if is_study_file(case):
            raise InputError(
                "is a study, not a case", place=Place(str(case)), fix="Name its base, or a case of its own"
            )
        loaded = load_case(case, spectra=spectrum_names())
        if output is not None:
            check_folder(output, force)
        built = build(loaded)
        structure = built.crossing.structure
        found = _found(structure, number)
    except InputError as error:
        return refuse(error)
    except (AnalysisError, NotPositiveDefinite) as error:
        warn(f"the analysis failed: {error}")
        return FAILED
    written: list[str] = []
    if output is not None:
        try:
            with staged(output) as stage:
                written = _write(structure, found, built.title, stage)
                publish(stage, output)
        except InputError as error:
            return refuse(error)
        except OSError as error:
            warn(f"{output}: the results cannot be written: {error.strerror or error}")
            return FAILED
    for line in modes_table(structure, found, built.title):
        say(line)
    if output is not None:
        say(f"Written to {output}: {', '.join(written)}")
    return DONE


def _found(structure: Structure, number: int | None) -> SystemModes:
    """The modes; that there are not so many is said of the option."""
    try:
        return modes_of(structure.system, number)
    except InputError as error:
        if error.field != "count":
            raise
        raise InputError(error.rule, field="--number", value=number, fix=error.fix) from None


def modes_table(structure: Structure, found: SystemModes, title: str) -> list[str]:
    """Lines of a table: frequency, period, damping and modal mass, then per direction Γ, mass and its sum."""
    part, system = found.participation, structure.system
    heads = ["mode", "f [Hz]", "T [s]", "damping", "mass [t]"]
    for name in found.directions:
        heads += [f"Γ {name}", f"m {name}", f"Σm {name}"]
    rows = []
    for i, (f, m) in enumerate(zip(found.modes.frequencies, part.modal_mass, strict=True)):
        period = f"{1.0 / f:.5g}" if f > 0.0 else "-"
        row = [str(i + 1), f"{f:.5g}", period, f"{100.0 * found.damping_ratio[i]:.3g} %", f"{m / 1e3:.5g}"]
        for j in range(len(found.directions)):
            shares = (part.share[i, j], part.cumulative[i, j])
            row += [f"{_clean(part.factor[i, j]):.4g}", *(f"{100.0 * _clean(s):.2f} %" for s in shares)]
        rows.append(row)
    widths = [max(len(row[k]) for row in (heads, *rows)) for k in range(len(heads))]
    masses = ", ".join(
        f"{mass / 1e3:.6g} t along {name}"
        for name, mass in zip(found.directions, part.total_mass, strict=True)
    )
    return [
        title,
        f"  {structure.name}, {len(system.free)} free d.o.f., mass {masses}",
        "",
        *("  ".join(text.rjust(w) for text, w in zip(row, widths, strict=True)) for row in (heads, *rows)),
        "",
        "mass: modal mass for a largest displacement of 1; Γ: participation factor; m: effective mass, Σm: its sum so far",
    ]


def _clean(value: float) -> float:
    """Rounding of modes that don't take part as zero."""
    return float(value) if abs(value) > 1e-9 else 0.0


def modes_content(structure: Structure, found: SystemModes, title: str) -> dict[str, Any]:
    """Content of modes.json; names carry their units."""
    part = found.participation
    modes = []
    for i, (f, omega) in enumerate(
        zip(found.modes.frequencies, found.modes.angular_frequencies, strict=True)
    ):
        along = {
            name: {
                "participation_factor": part.factor[i, j],
                "effective_mass_kg": part.effective_mass[i, j],
                "effective_mass_ratio": part.share[i, j],
                "cumulative_mass_ratio": part.cumulative[i, j],
            }
            for j, name in enumerate(found.directions)
        }
        modes.append(
            {
                "mode": i + 1,
                "frequency_Hz": f,
                "angular_frequency_rad_per_s": omega,
                "period_s": 1.0 / f if f > 0.0 else None,
                "damping_ratio": found.damping_ratio[i],
                "modal_mass_kg": part.modal_mass[i],
                "directions": along,
            }
        )
    return {
        "format": "axlespan modes",
        "format_version": FORMAT_VERSION,
        "title": title,
        "structure": structure.name,
        "free_dofs": len(structure.system.free),
        "total_mass_kg": dict(zip(found.directions, part.total_mass.tolist(), strict=True)),
        "modes": modes,
    }


def _write(structure: Structure, found: SystemModes, title: str, folder: Path) -> list[str]:
    """Write modes.json, figures, and shapes for ParaView where there is a model."""
    from axlespan.plot.modes import line_shapes, space_shape
    from axlespan.plot.standard import save
    from axlespan.plot.style import figure_of

    folder.mkdir(parents=True, exist_ok=True)
    text = to_json(modes_content(structure, found, title), indent=2)
    (folder / "modes.json").write_text(text + "\n", encoding="utf-8")
    figures = {"modes": figure_of(line_shapes(structure, found.modes))}
    if structure.model is not None:
        write_modes(structure, found.modes, folder / "modes.vtu")
        if np.ptp(structure.model.points[:, 1]) > 0.0:
            try:
                for i in range(min(len(found.modes), _PICTURES)):
                    figures[f"mode-{i + 1:02d}"] = space_shape(structure, found.modes, i).get_figure(
                        root=True
                    )
            except InputError as error:
                warn(f"no figures in space: {error}")
    pictures = [file.name for file in save(figures, folder)]
    return ["modes.json", *(["modes.vtu"] if structure.model is not None else []), *pictures]
