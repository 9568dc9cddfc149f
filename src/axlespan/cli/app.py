"""The commands and their options; what they do stands in modules that are loaded when a command runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from axlespan import __version__

app = typer.Typer(
    name="axlespan",
    help="Trains and trucks crossing bridges and track: vehicle-structure interaction by the direct method.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_CASE = Annotated[Path, typer.Argument(help="Case file (YAML).", metavar="CASE")]


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"axlespan {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Options of all commands."""


@app.command()
def run(
    case: _CASE,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Folder for the results; CASE without its ending by default."),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the results in an existing folder.")
    ] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw figures.")] = True,
    paraview: Annotated[
        bool,
        typer.Option("--paraview", help="Write fields.pvd: structure and wheels over time, for ParaView."),
    ] = False,
    report: Annotated[
        bool, typer.Option("--report", help="Write report.html: the result as one page, with an animation.")
    ] = False,
) -> None:
    """Simulate a case: writes result.nc, summary.json and figures."""
    from axlespan.cli.run import Wanted, run_case

    raise typer.Exit(run_case(case, output, force=force, wanted=Wanted(figures, paraview, report)))


@app.command()
def report(
    folder: Annotated[Path, typer.Argument(help="Folder of results, or a result.nc.", metavar="FOLDER")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="The page; report.html in the folder by default."),
    ] = None,
) -> None:
    """Write a result as one HTML page.

    It needs no server: tables, plots with zoom, maps and an animation of the crossing are in the file.
    """
    from axlespan.cli.report import make_report

    raise typer.Exit(make_report(folder, output))


@app.command()
def sweep(
    study: Annotated[Path, typer.Argument(help="Study file (YAML).", metavar="STUDY")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Folder of the store; STUDY without its ending by default."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Compute what is missing in a store of this study.")
    ] = False,
    workers: Annotated[
        int, typer.Option("--workers", min=1, help="Processes on this machine, each on one core.")
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            help="Dask scheduler, tcp://host:8786; local starts a Dask cluster of --workers here.",
        ),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Begin a very large study without asking.")] = False,
    only: Annotated[
        int | None, typer.Option("--only", help="Compute one scenario, with all its histories.", metavar="ID")
    ] = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw figures.")] = True,
) -> None:
    """Simulate all scenarios of a study into a folder."""
    from axlespan.cli.sweep import Wanted, run_sweep

    raise typer.Exit(run_sweep(study, output, Wanted(resume, workers, scheduler, yes, figures, only)))


@app.command()
def check(case: _CASE) -> None:
    """Say what a case or a study is, without running it."""
    from axlespan.cli.check import check_case

    raise typer.Exit(check_case(case))


@app.command()
def modes(
    case: _CASE,
    number: Annotated[
        int | None,
        typer.Option("-n", "--number", min=1, help="Number of modes; 10, or all if there are fewer."),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder for modes.json and figures of the shapes.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace what an existing folder holds.")] = False,
) -> None:
    """Print the natural modes of a case's structure.

    Frequencies, participation factors and effective masses.
    """
    from axlespan.cli.modes import show_modes

    raise typer.Exit(show_modes(case, number, output, force=force))


@app.command()
def examples(
    copy: Annotated[
        list[str] | None, typer.Argument(help="Names of examples to copy; none lists them.", metavar="NAME")
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder to copy to.")] = Path(),
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
) -> None:
    """List the cases that come with axlespan, or copy some.

    The name all copies every one.
    """
    from axlespan.cli.examples import list_or_copy

    raise typer.Exit(list_or_copy(copy or [], output, force=force))


@app.command()
def library(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Name of an entry, or a vehicle's file of your own; none lists all.", metavar="NAME"
        ),
    ] = None,
    copy: Annotated[
        Path | None, typer.Option("--copy", help="Write the vehicle's YAML to this file, to change it.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """List vehicles, trains, spectra and tracks, or show one.

    With all its numbers, their sources, axle loads and natural frequencies.
    """
    from axlespan.cli.library import show_library

    raise typer.Exit(show_library(name, copy, force=force))


@app.command()
def schema(
    study: Annotated[bool, typer.Option("--study", help="That of the study file.")] = False,
) -> None:
    """Print the JSON Schema of the case file, or of the study file."""
    from axlespan.cli.schema import print_schema

    raise typer.Exit(print_schema(study))


@app.command()
def verify(
    full: Annotated[bool, typer.Option("--full", help="Run the long cases too.")] = False,
    only: Annotated[
        str | None, typer.Option("--only", help="Run only cases whose name contains this.")
    ] = None,
) -> None:
    """Run the verification book.

    Prints case, quantity, expected and obtained value, and the error.
    """
    from axlespan.cli.verify import run_book

    raise typer.Exit(run_book(full=full, only=only))


@app.command()
def init(
    file: Annotated[Path, typer.Argument(help="File to write.")] = Path("case.yaml"),
    spans: Annotated[
        str | None, typer.Option(help="Span, or spans: '40 m', '18 m, 24 m, 18 m' or '3 x 25 m'.")
    ] = None,
    bridge_type: Annotated[str | None, typer.Option(help="prestressed-concrete, steel, ...")] = None,
    mass_per_length: Annotated[str | None, typer.Option(help="With all that stays on it: '15 t/m'.")] = None,
    frequency: Annotated[
        str | None, typer.Option(help="First frequency of the longest span: '4 Hz'.")
    ] = None,
    second_moment: Annotated[str | None, typer.Option(help="In place of the frequency: '2.9 m^4'.")] = None,
    damping: Annotated[str | None, typer.Option(help="Damping ratio: '1 %'.")] = None,
    track: Annotated[str | None, typer.Option(help="none, ballasted or slab.")] = None,
    train: Annotated[str | None, typer.Option(help="A name in axlespan library.")] = None,
    speed: Annotated[str | None, typer.Option(help="'250 km/h'.")] = None,
    irregularity: Annotated[str | None, typer.Option(help="none, or a spectrum: german-low.")] = None,
    line_speed: Annotated[str | None, typer.Option(help="For verdicts of the code; none: without.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Write a case file of your own, with comments.

    Asks for what is not given as an option; without a terminal it takes what is usual.
    """
    from axlespan.cli.init import Options, write_case

    options = Options(
        spans,
        bridge_type,
        mass_per_length,
        frequency,
        second_moment,
        damping,
        track,
        train,
        speed,
        irregularity,
        line_speed,
    )
    raise typer.Exit(write_case(file, options, force=force))


@app.command()
def doctor() -> None:
    """Say what is installed, and how fast this machine is."""
    from axlespan.cli.doctor import look

    raise typer.Exit(look())
