"""Records of a monitoring system: sampled, filtered, noisy and quantized histories of sensors.

The motion of the structure is filtered before it is sampled, as a data logger does: a Butterworth filter of order
8 at 0.4 times the sampling rate, forward and backward so that nothing is delayed, and a cubic spline through the
time steps, read at the sampling times. Then noise is added and the values are rounded to what the converter tells apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.study.case import Case
from axlespan.study.checks import Measured, OneOf, Whole
from axlespan.study.sweep.chance import SEED
from axlespan.study.sweep.node import Node
from axlespan.units import ACCELERATION, FREQUENCY, LENGTH, RATIO, SPEED, Dimension

FloatArray = npt.NDArray[np.float64]

QUANTITIES: Final[Mapping[str, Dimension]] = {
    "sensor_acceleration": ACCELERATION,
    "sensor_velocity": SPEED,
    "sensor_displacement": LENGTH,
}
_EXAMPLE: Final = (
    "records: {sampling_rate: 200 Hz, noise: {std: 5 mm/s^2}, quantization: {bits: 16, range: 20 m/s^2}}"
)
# Corner of the anti-alias filter as a share of the sampling rate, and its order (doubled by going both ways).
_CORNER, _ORDER = 0.4, 8


@dataclass(frozen=True)
class Recording:
    """What a monitoring system makes of the motion at the sensors."""

    rate: float  # [1/s]
    quantity: str = "sensor_acceleration"
    noise: float = 0.0  # standard deviation of white noise, in the unit of the quantity
    noise_share: float = 0.0  # of the standard deviation of each record [-]
    seed: int = 1
    bits: int | None = None
    limit: float = 0.0  # largest value that the converter tells apart, in the unit of the quantity

    def require(self, case: Case) -> None:
        """Require time steps that resolve the sampling rate, all of them kept, and sensors.

        Raises
        ------
        InputError
            Fields are paths in the study.
        """
        if self.rate * case.analysis.time_step > 1.0 + 1e-9:
            raise InputError(
                f"must be at most {1.0 / case.analysis.time_step:g} Hz, the rate of the time steps",
                field="records.sampling_rate",
                fix="Use a shorter time_step, or a lower rate",
            )
        if case.output.every != 1:
            rule = "need every time step: output.every of the base thins them without a filter"
            raise InputError(rule, field="records", fix="Leave output.every out")
        if not case.output.sensors:
            raise InputError(
                "need sensors", field="records", fix="Add output: {sensors: {midspan: 12.5 m}} to the base"
            )

    def record(self, values: FloatArray, time_step: float, scenario: int) -> FloatArray:
        """Records (n_sample, n_sensor) of histories (n_step, n_sensor) at all time steps.

        The same scenario gets the same noise, alone or among others.
        """
        sampled = self._sampled(values, time_step)
        random = np.random.default_rng([self.seed, scenario])
        scale = self.noise + self.noise_share * sampled.std(axis=0)
        noisy = sampled + scale * random.standard_normal(sampled.shape)
        if self.bits is None:
            return np.asarray(noisy)
        step = 2.0 * self.limit / 2**self.bits
        codes = np.clip(np.round(noisy / step), -(2 ** (self.bits - 1)), 2 ** (self.bits - 1) - 1)
        return np.asarray(codes * step)

    def _sampled(self, values: FloatArray, time_step: float) -> FloatArray:
        from scipy.interpolate import CubicSpline
        from scipy.signal import butter, sosfiltfilt

        corner = _CORNER * self.rate
        if corner < 0.5 / time_step * 0.99 and len(values) > 1:
            sections = butter(_ORDER, corner, fs=1.0 / time_step, output="sos")
            # a few periods of the corner frequency on either side: the structure is near rest there
            room = min(len(values) - 1, int(8.0 / (corner * time_step)))
            values = sosfiltfilt(sections, values, axis=0, padtype="constant", padlen=room)
        count = int((len(values) - 1) * time_step * self.rate * (1.0 + 1e-12)) + 1
        times = np.arange(len(values)) * time_step
        if len(values) < 2:
            return np.asarray(values)
        wanted = np.minimum(np.arange(count) / self.rate, times[-1])
        return np.asarray(CubicSpline(times, values, axis=0)(wanted))


def recording_of(node: Node) -> Recording:
    """Read ``records``."""
    known = ("sampling_rate", "quantity", "noise", "seed", "quantization")
    parts = node.keys(known, _EXAMPLE)
    if "sampling_rate" not in parts:
        raise node.source.blame((*node.path, "sampling_rate"), "is missing", f"Write {_EXAMPLE}")
    quantity = (
        parts["quantity"].checked(OneOf(tuple(QUANTITIES))) if "quantity" in parts else "sensor_acceleration"
    )
    more: dict[str, Any] = {}
    if "noise" in parts:
        more |= _noise(parts["noise"], QUANTITIES[quantity])
    if "quantization" in parts:
        more |= _quantization(parts["quantization"], QUANTITIES[quantity])
    if "seed" in parts:
        more["seed"] = parts["seed"].checked(SEED)
    rate = float(parts["sampling_rate"].checked(Measured(FREQUENCY, above=0.0)))
    return Recording(rate, quantity, **more)


def _noise(node: Node, dimension: Dimension) -> dict[str, float]:
    parts = node.keys(("std", "share"), "noise: {std: 5 mm/s^2}")
    if len(parts) != 1:
        raise node.fault("must have std or share", "Write noise: {std: 5 mm/s^2}, or {share: 5 %}")
    if "std" in parts:
        return {"noise": float(parts["std"].checked(Measured(dimension, at_least=0.0)))}
    return {"noise_share": float(parts["share"].checked(Measured(RATIO, at_least=0.0)))}


def _quantization(node: Node, dimension: Dimension) -> dict[str, Any]:
    parts = node.keys(("bits", "range"), "quantization: {bits: 16, range: 20 m/s^2}")
    for key in ("bits", "range"):
        if key not in parts:
            fix = "Write quantization: {bits: 16, range: 20 m/s^2}"
            raise node.source.blame((*node.path, key), "is missing", fix)
    bits = int(parts["bits"].checked(Whole(at_least=2, at_most=32)))
    return {"bits": bits, "limit": float(parts["range"].checked(Measured(dimension, above=0.0)))}
