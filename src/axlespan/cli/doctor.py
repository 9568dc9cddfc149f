"""``axlespan doctor``: what is installed, which solver would be used, and how fast this machine is."""

from __future__ import annotations

import importlib
import importlib.metadata
import os
import platform
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from axlespan import __version__
from axlespan.cli.messages import DONE, FAILED, say


@dataclass(frozen=True)
class Part:
    """A package that axlespan needs or can use."""

    package: str  # as pip calls it
    module: str
    use: str
    extra: str | None = None  # of axlespan, that brings it; None: always needed


PARTS = (
    Part("numpy", "numpy", "arrays"),
    Part("scipy", "scipy", "sparse matrices, SuperLU"),
    Part("h5py", "h5py", "result files"),
    Part("h5netcdf", "h5netcdf", "result files"),
    Part("pydantic", "pydantic", "case files"),
    Part("ruamel.yaml", "ruamel.yaml", "case files"),
    Part("typer", "typer", "commands"),
    Part("rich", "rich", "progress"),
    Part("matplotlib", "matplotlib", "figures"),
    Part("mkl", "axlespan.linalg.mkl_library", "PARDISO, for large wide models", "mkl"),
    Part("numba", "numba", "compiled loops, many crossings at once", "numba"),
    Part("meshlane", "meshlane", "more mesh formats", "mesh"),
    Part("xarray", "xarray", "Result.to_xarray", "xarray"),
    Part("pandas", "pandas", "tables of results and studies", "study"),
    Part("pyarrow", "pyarrow", "stores of studies", "study"),
    Part("distributed", "distributed", "studies on a cluster", "dask"),
)


def look() -> int:
    """Print the findings; the exit code says whether what is needed is there and computes rightly."""
    for line in _machine():
        say(line)
    say()
    missing = _packages()
    say()
    right = _speed() if not missing else False
    say()
    say(_advice(missing, right))
    return DONE if right and not missing else FAILED


def _machine() -> list[str]:
    threads = os.environ.get("OMP_NUM_THREADS", "not set")
    return [
        f"axlespan    {__version__}",
        f"python      {platform.python_version()} ({sys.executable})",
        f"machine     {platform.machine()}, {platform.system()} {platform.release()}, {os.cpu_count()} cores{_memory()}",
        f"threads     OMP_NUM_THREADS {threads}",
    ]


def _memory() -> str:
    if not hasattr(os, "sysconf") or "SC_PHYS_PAGES" not in os.sysconf_names:
        return ""
    return f", {os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE') / 2**30:.1f} GiB memory"


def _packages() -> list[Part]:
    """Print every part with its version; those that are needed but not there."""
    missing = []
    for part in PARTS:
        version, fault = _version(part)
        what = version if version else (f"fails: {fault}" if fault else "not installed")
        hint = "" if version or part.extra is None else f"; pip install 'axlespan[{part.extra}]'"
        say(f"{part.package:<12}{what:<14}{part.use}{hint}")
        if not version and part.extra is None:
            missing.append(part)
    return missing


def _version(part: Part) -> tuple[str, str]:
    """Return the version of a part, or what went wrong with it; both empty if it is not there."""
    try:
        version = importlib.metadata.version(part.package)
    except importlib.metadata.PackageNotFoundError:
        return "", ""
    try:
        module = importlib.import_module(part.module)
        if part.package == "mkl":
            module.load_mkl()
    except Exception as error:  # whatever breaks an installation is what is looked for
        return "", f"{type(error).__name__}: {error}".splitlines()[0][:80]
    return version, ""


def _speed() -> bool:
    """Print how fast this machine is, and whether it computes rightly."""
    from axlespan.linalg.factor import available, choose

    for _, matrix in _matrices():  # what is compiled or loaded at the first call is not speed
        _times(matrix, str(choose(matrix)))
    say(
        f"solvers     {', '.join(available())}; chosen for each matrix, `axlespan check CASE` says which and why"
    )
    for name, matrix in _matrices():
        choice = choose(matrix)
        factor_time, solve_time = _times(matrix, str(choice))
        say(f"{'':<12}{name}: {choice}, factor {1e3 * factor_time:.1f} ms, solve {1e3 * solve_time:.3f} ms")
    return _example()


def _matrices() -> list[tuple[str, Any]]:
    import scipy.sparse as sp

    def laplacian(n: int) -> sp.csr_array:
        return sp.csr_array(sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n)))

    def grid(*sizes: int) -> sp.csr_array:
        result = laplacian(sizes[0])
        for size in sizes[1:]:
            result = sp.csr_array(
                sp.kron(result, sp.eye_array(size)) + sp.kron(sp.eye_array(result.shape[0]), laplacian(size))
            )
        return result

    return [("track, 5 400 equations", grid(1350, 4)), ("solid, 12 000 equations", grid(60, 20, 10))]


def _times(matrix: Any, kind: str) -> tuple[float, float]:
    import numpy as np

    from axlespan.linalg.factor import factorize

    begun = time.perf_counter()
    factor = factorize(matrix, kind=kind)
    factored = time.perf_counter() - begun
    load = np.ones(matrix.shape[0])
    return factored, min(_timed(lambda: factor.solve(load)) for _ in range(5))


def _timed(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def _example() -> bool:
    """Run N12's example 3.1 and compare the deflection with the semi-analytical solution."""
    from axlespan.verification.book import run, select

    (report,) = run(select("neves-3.1"))
    say(
        f"check       N12's example 3.1 against its semi-analytical solution: {'ok' if report.ok else 'WRONG'}"
    )
    for row in report.rows:
        if not row.ok:
            say(f"{'':<12}{row.quantity}: {row.obtained:.6g} {row.unit}, expected {row.expected:.6g}")
    if report.failure:
        say(f"{'':<12}{report.failure}")
    return report.ok


def _advice(missing: Sequence[Part], right: bool) -> str:
    if missing:
        return f"Needed but not there: {', '.join(part.package for part in missing)}. Install axlespan again."
    if not right:
        return "This installation computes wrong numbers: reinstall numpy, scipy and axlespan, and run axlespan verify."
    return "All is in order. Next: axlespan init, or axlespan examples."
