"""What importing the package, and asking the command for help, loads."""

import subprocess
import sys

import pytest

import axlespan

HEAVY = (
    "matplotlib",
    "pydantic",
    "ruamel",
    "typer",
    "rich",
    "numpy",
    "scipy",
    "h5py",
    "h5netcdf",
    "numba",
    "xarray",
)
COMPUTING = (*HEAVY[:2], "ruamel", *HEAVY[5:])


def loaded_by(code):
    """The heavy packages that a fresh interpreter holds after some code."""
    listing = f"{code}\nimport sys\nprint(*(name for name in {HEAVY!r} if name in sys.modules))"
    done = subprocess.run([sys.executable, "-c", listing], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_the_package_alone_loads_nothing_heavy():
    assert loaded_by("import axlespan") == set()


def test_a_simulation_loads_no_plotting_and_no_case_files():
    loaded = loaded_by(
        "import axlespan\naxlespan.simulate, axlespan.bridges, axlespan.vehicles, axlespan.Train"
    )
    assert {"numpy", "scipy"} <= loaded
    assert not loaded & {"matplotlib", "pydantic", "ruamel", "typer", "rich"}


def test_help_loads_no_computing():
    code = """
import contextlib, io
from axlespan.cli.app import app
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    app(["--help"])
"""
    assert not loaded_by(code) & set(COMPUTING)


def test_checking_a_case_loads_no_plotting():
    assert "matplotlib" not in loaded_by("import axlespan.cli.check, axlespan.cli.run")


@pytest.mark.parametrize("name", axlespan.__all__)
def test_public_names_are_there(name):
    assert getattr(axlespan, name) is not None
    assert name in dir(axlespan)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'axlespan' has no attribute 'Bridge'"):
        axlespan.Bridge  # noqa: B018
