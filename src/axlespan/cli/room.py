"""Whether a run fits into the memory and onto the disk of this machine."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from axlespan.cli.messages import warn
from axlespan.study.build import BuiltCase
from axlespan.study.size import Size, require_memory, size_text

# Where Linux says how much memory a container may use.
_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")


def check_size(built: BuiltCase, folder: Path | None = None) -> Size:
    """Refuse what the memory of this machine cannot hold; warn of what it can hardly hold.

    Raises
    ------
    InputError
    """
    size = require_memory(built.plan, built.loaded.source, memory())
    free, space = free_memory(), free_disk(folder or Path())
    if size.memory > free:
        warn(f"warning: the run takes about {size_text(size.memory)} of memory; {size_text(free)} are free")
    if size.result > space > 0.0:  # some special file systems say 0
        needs = f"the results may take {size_text(size.result)}"
        warn(f"warning: {needs}; {size_text(space)} are free on the disk")
    return size


def memory() -> float:
    """Memory that a process can have [byte]; infinite where it cannot be told."""
    known = [_physical(), *(_number(Path(name)) for name in _LIMITS)]
    return min(known)


def free_memory() -> float:
    """Memory that is free now [byte]; infinite where it cannot be told."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        entries = dict(line.split(":", 1) for line in lines if ":" in line)
        return min(memory(), 1024.0 * float(entries["MemAvailable"].split()[0]))
    except (OSError, ValueError, LookupError):
        return memory()


def free_disk(folder: Path) -> float:
    """Space that is free where a folder is or will be [byte]; infinite where it cannot be told."""
    for place in (folder.absolute(), *folder.absolute().parents):
        try:
            return float(shutil.disk_usage(place).free)
        except OSError:
            continue
    return float("inf")


def _physical() -> float:
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * float(os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):  # Windows has no sysconf
        return float("inf")


def _number(path: Path) -> float:
    try:
        return float(path.read_text(encoding="ascii"))
    except (OSError, ValueError):  # "max": no limit
        return float("inf")
