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
) -> None:
    """Simulate a case: writes result.nc, summary.json and figures."""
    from axlespan.cli.run import run_case

    raise typer.Exit(run_case(case, output, force=force, figures=figures, paraview=paraview))


@app.command()
def check(case: _CASE) -> None:
    """Read and build a case without running it, and say what it is."""
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
def schema() -> None:
    """Print the JSON Schema of the case file."""
    from axlespan.cli.schema import print_schema

    raise typer.Exit(print_schema())


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
