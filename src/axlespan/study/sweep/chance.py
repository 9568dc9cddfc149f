"""Random variables of a study: distributions by the names of scipy.stats, samples by scipy.stats.qmc."""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.study.checks import OneOf, Whole
from axlespan.study.faults import nearest
from axlespan.study.sweep.node import Node
from axlespan.study.sweep.ranges import MOST, PLAIN, Amount, alike, amount

FloatArray = npt.NDArray[np.float64]

METHODS: Final = ("latin-hypercube", "sobol", "random")
SEED: Final = Whole(at_least=0, at_most=2**63 - 1)

_EXAMPLE: Final = "{distribution: normal, mean: 34 GPa, std: 2 GPa}"
_SAMPLING: Final = "{method: latin-hypercube, count: 100, seed: 1}"
# What a distribution with everyday parameters needs, and may have.
_EVERYDAY: Final[Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    "normal": (("mean", "std"), ("from", "to")),
    "lognormal": (("mean", "std"), ()),
    "uniform": (("from", "to"), ()),
    "triangular": (("from", "mode", "to"), ()),
}
# Quantiles stay this far from 0 and 1, where many distributions have no finite value.
_MARGIN: Final = 1e-12

Quantile = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class Variable:
    """A random variable: values from shares of probability."""

    quantile: Quantile
    like: Amount  # the unit of its values
    words: str

    def values(self, shares: FloatArray) -> FloatArray:
        """Values (n,) in the unit of the variable, from shares (n,) between 0 and 1."""
        return np.asarray(self.quantile(np.clip(shares, _MARGIN, 1.0 - _MARGIN)), dtype=np.float64)

    def texts(self, shares: FloatArray) -> list[Any]:
        """The same, as one writes them in a case file."""
        return [self.like.text(value) for value in self.values(shares).tolist()]


@dataclass(frozen=True)
class Sampling:
    """How random variables are sampled."""

    method: str
    count: int
    seed: int

    def shares(self, dimensions: int) -> FloatArray:
        """Shares (count, dimensions) between 0 and 1."""
        if self.method == "random":
            return np.random.default_rng(self.seed).random((self.count, dimensions))
        from scipy.stats import qmc

        engines: dict[str, Any] = {"latin-hypercube": qmc.LatinHypercube, "sobol": qmc.Sobol}
        kind = engines[self.method]
        # scipy renamed the seed of its samplers to rng
        name = "rng" if "rng" in inspect.signature(kind).parameters else "seed"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of counts that are no power of 2; check says so
            return np.asarray(kind(d=dimensions, **{name: self.seed}).random(self.count))

    @property
    def notes(self) -> list[str]:
        """What a user may want to know of it."""
        if self.method != "sobol" or self.count & (self.count - 1) == 0:
            return []
        near = 2 ** round(math.log2(self.count))
        return [f"Sobol points are balanced at powers of 2: {near} would serve better than {self.count}"]


def sampling_of(node: Node) -> Sampling:
    """Read ``sampling``."""
    parts = node.keys(("method", "count", "seed"), _SAMPLING)
    for name in ("method", "count"):
        if name not in parts:
            raise node.source.blame((*node.path, name), "is missing", f"Write sampling: {_SAMPLING}")
    seed = parts["seed"].checked(SEED) if "seed" in parts else 1
    return Sampling(
        parts["method"].checked(OneOf(METHODS)), parts["count"].checked(Whole(at_most=MOST)), seed
    )


def variable_of(node: Node) -> Variable:
    """Read ``{distribution: ..., ...}``.

    Raises
    ------
    InputError
        If the distribution is unknown, or its parameters are impossible.
    """
    name = node.data.get("distribution")
    if name in _EVERYDAY:
        return _everyday(node, str(name))
    return _from_scipy(node, name)


def _everyday(node: Node, name: str) -> Variable:
    from scipy import stats

    needed, optional = _EVERYDAY[name]
    parts = node.keys(("distribution", *needed, *optional), _EXAMPLE)
    for key in needed:
        if key not in parts:
            shown = ", ".join(f"{one}: ..." for one in needed)
            fix = f"Write {{distribution: {name}, {shown}}}"
            raise node.source.blame((*node.path, key), "is missing", fix)
    like = amount(parts[needed[0]])
    value = {key: alike(part, like).number for key, part in parts.items() if key != "distribution"}
    if "std" in value and value["std"] <= 0.0:
        raise parts["std"].fault("must be positive", "Leave the variable out of vary if it does not vary")
    if "from" in value and "to" in value and value["to"] <= value["from"]:
        raise parts["to"].fault("must be greater than from", "Exchange the two")
    if name == "normal" and ("from" in value or "to" in value):
        low, high = value.get("from", -math.inf), value.get("to", math.inf)
        mean, std = value["mean"], value["std"]
        frozen: Any = stats.truncnorm((low - mean) / std, (high - mean) / std, loc=mean, scale=std)
    elif name == "normal":
        frozen = stats.norm(value["mean"], value["std"])
    elif name == "lognormal":
        if value["mean"] <= 0.0:
            raise parts["mean"].fault("must be positive for a lognormal distribution")
        shape = math.sqrt(math.log1p((value["std"] / value["mean"]) ** 2))
        frozen = stats.lognorm(shape, scale=value["mean"] * math.exp(-0.5 * shape**2))
    elif name == "uniform":
        frozen = stats.uniform(value["from"], value["to"] - value["from"])
    else:
        if not value["from"] <= value["mode"] <= value["to"]:
            raise parts["mode"].fault("must be between from and to")
        width = value["to"] - value["from"]
        frozen = stats.triang((value["mode"] - value["from"]) / width, loc=value["from"], scale=width)
    return _usable(node, frozen, like, name)


def _from_scipy(node: Node, name: Any) -> Variable:
    from scipy import stats

    place = node.child("distribution")
    kinds = (stats.rv_continuous, stats.rv_discrete)
    known = [one for one in dir(stats) if isinstance(getattr(stats, one), kinds)]
    if not isinstance(name, str) or name not in known:
        near = nearest(name, (*_EVERYDAY, *known)) if isinstance(name, str) else None
        fix = f"Did you mean {near}?" if near else f"Write {', '.join(_EVERYDAY)}, or a name of scipy.stats"
        raise place.fault("no such distribution", fix)
    kind = getattr(stats, name)
    shapes = tuple(part.strip() for part in kind.shapes.split(",")) if kind.shapes else ()
    scaled = ("loc", "scale") if isinstance(kind, stats.rv_continuous) else ("loc",)
    parts = node.keys(("distribution", *shapes, *scaled), f"{{distribution: {name}, ...}}")
    for shape in shapes:
        if shape not in parts:
            fix = f"Add {shape}, a shape parameter of scipy.stats.{name}"
            raise node.source.blame((*node.path, shape), "is missing", fix)
    measured = [parts[key] for key in scaled if key in parts]
    like = amount(measured[0]) if measured else PLAIN
    where = {key: alike(parts[key], like).number for key in scaled if key in parts}
    if where.get("scale", 1.0) <= 0.0:
        raise parts["scale"].fault("must be positive")
    numbers = [alike(parts[shape], PLAIN).number for shape in shapes]
    return _usable(node, kind(*numbers, **where), like, name)


def _usable(node: Node, frozen: Any, like: Amount, name: str) -> Variable:
    """The variable, if its quantiles are numbers."""
    with np.errstate(all="ignore"):
        probe = np.asarray(frozen.ppf(np.array([1e-6, 0.5, 1.0 - 1e-6])), dtype=float)
    if not np.all(np.isfinite(probe)):
        shown = ", ".join(f"{key}: {value}" for key, value in node.data.items() if key != "distribution")
        rule = f"{name} has no values with these parameters ({shown})"
        raise node.fault(rule, "Look up its parameters in scipy.stats")
    return Variable(frozen.ppf, like, name)
