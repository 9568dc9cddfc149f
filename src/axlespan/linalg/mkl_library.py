"""Intel's Math Kernel Library (``libmkl_rt``), found and loaded when first asked for."""

from __future__ import annotations

import ctypes
import ctypes.util
import importlib.metadata
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

_FILE = re.compile(r"(?:lib)?mkl_rt(?:\.\d+)?\.(?:so|dll|dylib)(?:\.\d+)?")
_CBWR_AUTO = 2  # MKL_CBWR_AUTO of mkl_types.h: the fastest code path that gives the same numbers at every run


@cache
def find_mkl() -> str | None:
    """Return the path of ``libmkl_rt``, or None where there is none.

    Looked for among the files of the installed package ``mkl``, in the environment's folders, and where the
    system keeps its libraries, in this order.
    """
    for path in _candidates():
        if _FILE.fullmatch(path.name) and path.is_file():
            return str(path)
    return ctypes.util.find_library("mkl_rt")


def _candidates() -> Iterator[Path]:
    try:
        files = importlib.metadata.files("mkl") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for file in files:
        yield Path(str(file.locate())).resolve()
    prefix = Path(sys.prefix)
    for folder in (prefix / "lib", prefix / "Library" / "bin", prefix / "bin"):
        yield from sorted(folder.glob("*mkl_rt*"), reverse=True)


@cache
def load_mkl() -> ctypes.CDLL:
    """Load ``libmkl_rt`` and declare the three functions that are used.

    The functions are the C ones, with capitals: their lower-case twins are Fortran and take addresses.
    ``pardiso_64`` has 64-bit integers whatever interface layer the process has chosen.

    Raises
    ------
    OSError
        When there is none, or it cannot be loaded.
    """
    path = find_mkl()
    if path is None:
        raise OSError("libmkl_rt was not found")
    library = ctypes.CDLL(path)
    library.MKL_CBWR_Set.argtypes = [ctypes.c_int]
    library.MKL_CBWR_Set.restype = ctypes.c_int
    library.MKL_Set_Num_Threads_Local.argtypes = [ctypes.c_int]
    library.MKL_Set_Num_Threads_Local.restype = ctypes.c_int
    library.pardiso_64.argtypes = [ctypes.c_void_p] * 16
    library.pardiso_64.restype = None
    library.MKL_CBWR_Set(_CBWR_AUTO)  # refused, and no harm done, when someone has used MKL before
    return library
