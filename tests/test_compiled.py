"""Machine code on disk is that of today's source."""

import importlib.util
import os

import pytest

from axlespan.compiled import as_compiled

pytest.importorskip("numba")

INNER = "from axlespan.compiled import as_compiled\n\n@as_compiled\ndef half(x):\n    return {share} * x\n"
OUTER = (
    "from inner_loop import half\nfrom axlespan.compiled import as_compiled\n\nSHIFT = {shift}\n\n"
    "@as_compiled\ndef loop(x):\n    return half(x) + SHIFT\n"
)


def load(folder, monkeypatch, share, shift):
    """Write two modules with the same time stamps as ever, import them anew, and call the outer loop."""
    from axlespan import compiled

    compiled._fingerprint.cache_clear()
    modules = {}
    for name, text in (("inner_loop", INNER.format(share=share)), ("outer_loop", OUTER.format(shift=shift))):
        file = folder / f"{name}.py"
        file.write_text(text)
        os.utime(file, (1e9, 1e9))
        spec = importlib.util.spec_from_file_location(name, file)
        modules[name] = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(__import__("sys").modules, name, modules[name])
        spec.loader.exec_module(modules[name])
    return modules["outer_loop"].loop(8.0)


def test_what_a_loop_calls_is_looked_at(tmp_path, monkeypatch):
    """Neither the time nor the size of the outer file says that the inner one, or a constant, has changed."""
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    assert load(tmp_path, monkeypatch, "0.5", "1.0") == 5.0
    assert load(tmp_path, monkeypatch, "0.5", "1.0") == 5.0  # from disk
    assert load(tmp_path, monkeypatch, "2.5", "1.0") == 21.0
    assert load(tmp_path, monkeypatch, "2.5", "3.0") == 23.0


def test_a_plain_loop_is_compiled():
    def twice(x):
        return 2.0 * x

    assert as_compiled(twice)(3.0) == 6.0
