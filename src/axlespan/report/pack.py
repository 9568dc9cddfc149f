"""Arrays of a page in one compressed block of text, which the page unpacks itself."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass
class Pack:
    """Collects arrays; each is known by its number.

    Bytes of equal weight stand together (first all lowest bytes, and so on), which halves the size of smooth
    histories under deflate.
    """

    _directory: list[list[Any]] = field(default_factory=list)  # type, count
    _parts: list[bytes] = field(default_factory=list)

    def add(self, values: npt.ArrayLike, kind: str = "f4") -> int:
        """Add an array as f4, f8, i2 or i4 (little-endian); its number."""
        data = np.ascontiguousarray(np.asarray(values).ravel(), dtype=f"<{kind}")
        raw = data.view(np.uint8).reshape(-1, data.itemsize)
        self._directory.append([kind, len(data)])
        self._parts.append(raw.T.tobytes())
        return len(self._directory) - 1

    def quantized(self, values: FloatArray) -> dict[str, Any]:
        """Add an array as whole numbers from -32 000 to 32 000, with what turns them back.

        The error is at most 1/128 000 of the range; nan becomes -32 768.
        """
        finite = values[np.isfinite(values)]
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        scale = (high - low) / 64_000.0 or 1.0
        offset = 0.5 * (low + high)
        whole = np.where(np.isfinite(values), np.round((values - offset) / scale), -32_768.0)
        return {"a": self.add(whole, "i2"), "scale": scale, "offset": offset, "shape": list(values.shape)}

    def directory(self) -> list[list[Any]]:
        """Type and number of values of each array, in order."""
        return self._directory

    def text(self) -> str:
        """All arrays, compressed, in base 64."""
        return base64.b64encode(zlib.compress(b"".join(self._parts), 9)).decode("ascii")
