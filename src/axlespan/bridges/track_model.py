"""Rails, springs, sleepers and slabs of a track as nodes and parts of a model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from axlespan.bridges.track import Layer, Track
from axlespan.bridges.track_layout import Layout
from axlespan.elements.beam import BeamProperties
from axlespan.model.model import Model, Tie
from axlespan.model.parts import BeamPart, MassPart, Part, SpringPart

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Length of a sleeper and width of a slab, for their inertia in rolling [m].
WIDTH = 2.6
# Heights of rails and layers above the running surface of the bridge, for figures only [m].
_RAIL, _STEP = 1.0, 0.3
# Poisson's ratio of slabs, for torsion.
_SLAB_RATIO = 0.2


@dataclass(frozen=True, eq=False)
class Side:
    """One rail of two, or both as one: where it lies and what stands under it."""

    name: str  # "", or "-left" and "-right", at the end of the names of parts
    rail: FloatArray  # (n_rail, 3) points of the rail's nodes [m]
    at_support: IntArray  # (n_support,) the rail's nodes over the supports
    base: IntArray  # (n_support,) nodes of the model on which the last springs stand
    share: float  # of the track's values: 1 for both rails, 1/2 for one
    stiffer: FloatArray  # (n_rail - 1,) factors on the bending stiffness of the rail's elements


@dataclass(eq=False)
class _Springs:
    pairs: list[IntArray] = field(default_factory=list)
    stiffness: list[FloatArray] = field(default_factory=list)
    damping: list[FloatArray] = field(default_factory=list)

    def add(self, pairs: IntArray, stiffness: FloatArray, damping: FloatArray) -> None:
        self.pairs.append(pairs)
        self.stiffness.append(np.broadcast_to(stiffness, len(pairs)))
        self.damping.append(np.broadcast_to(damping, len(pairs)))

    def part(self, name: str) -> SpringPart:
        return SpringPart(
            name,
            np.concatenate(self.pairs),
            np.concatenate(self.stiffness)[:, None],
            np.concatenate(self.damping)[:, None],
        )


class TrackBuilder:
    """Adds a track to a model, layer by layer; parts are called by layer and side: ``pads``, ``ballast-left``."""

    def __init__(self, model: Model, track: Track, layout: Layout) -> None:
        self.model, self._track, self._layout = model, track, layout
        self._springs: dict[str, _Springs] = {}
        self._masses: dict[str, list[tuple[IntArray, float]]] = {}
        self._beams: dict[str, list[tuple[IntArray, Layer, float]]] = {}

    def lay(self, sides: list[Side]) -> tuple[Model, list[IntArray]]:
        """The model with the track, and the nodes of each rail from its beginning to its end."""
        rails = [self._lay_rail(side) for side in sides]
        for deck in (False, True):
            chosen = np.flatnonzero(self._layout.on_deck == deck)
            if len(chosen):
                self._lay_layers(sides, rails, chosen, deck)
        parts: list[Part] = [springs.part(name) for name, springs in self._springs.items()]
        parts += [self._mass_part(name, masses) for name, masses in self._masses.items()]
        self.model = replace(self.model, parts=(*self.model.parts, *parts))
        return self.model, rails

    def _new_nodes(self, points: FloatArray) -> IntArray:
        first = len(self.model.points)
        self.model = self.model.with_nodes(points)
        return np.arange(first, len(self.model.points))

    def _lay_rail(self, side: Side) -> IntArray:
        nodes = self._new_nodes(side.rail + [0.0, 0.0, _RAIL])
        properties = BeamProperties(
            bending_stiffness_y=side.share * self._track.bending_stiffness * side.stiffer,
            mass_per_length=side.share * self._track.mass_per_length,
        )
        pairs = np.column_stack([nodes[:-1], nodes[1:]])
        self._add_part(BeamPart(f"rail{side.name}", pairs, properties, ("z", "ry")))
        return nodes

    def _add_part(self, part: Part) -> None:
        self.model = self.model.with_part(part)

    def _lay_layers(self, sides: list[Side], rails: list[IntArray], chosen: IntArray, deck: bool) -> None:
        layers = self._track.deck_layers if deck else self._track.layers
        upper = [nodes[side.at_support[chosen]] for side, nodes in zip(sides, rails, strict=True)]
        for depth, layer in enumerate(layers):
            if layer.body is None:
                lower = [side.base[chosen] for side in sides]
            elif depth == 0 and len(sides) == 2:
                lower = self._stiff_across(layer, sides, chosen)
            else:
                lower = [self._bodies(layer, side, chosen, depth) for side in sides]
            for side, above, below in zip(sides, upper, lower, strict=True):
                factor = side.share * self._layout.factor[layer.name][chosen]
                springs = self._springs.setdefault(layer.name + side.name, _Springs())
                pairs = np.column_stack([below, above])
                springs.add(pairs, factor * layer.stiffness, factor * layer.damping)
            upper = lower

    def _bodies(self, layer: Layer, side: Side, chosen: IntArray, depth: int) -> IntArray:
        """Nodes of sleepers, ballast masses or slabs of one side, with their mass and what joins them."""
        assert layer.body is not None
        points = side.rail[side.at_support[chosen]] + [0.0, 0.0, _RAIL - _STEP * (depth + 1)]
        nodes = self._new_nodes(points)
        if layer.bending_stiffness > 0.0:
            self._slab(layer, nodes, chosen, side.share, layer.body + side.name, ("z", "ry"))
        else:
            self._masses.setdefault(layer.body + side.name, []).append((nodes, side.share * layer.mass))
        if layer.shear_stiffness > 0.0 or layer.shear_damping > 0.0:
            pairs = self._neighbors(nodes, chosen)
            if len(pairs):
                name = f"{layer.name} shear{side.name}"
                values = (
                    np.full(len(pairs), side.share * v) for v in (layer.shear_stiffness, layer.shear_damping)
                )
                self._springs.setdefault(name, _Springs()).add(pairs, *values)
        return nodes

    def _stiff_across(self, layer: Layer, sides: list[Side], chosen: IntArray) -> list[IntArray]:
        """Sleepers or slabs under two rails: rigid across, they move up and down and roll."""
        assert layer.body is not None
        places = [side.rail[side.at_support[chosen]] + [0.0, 0.0, _RAIL - _STEP] for side in sides]
        middle = 0.5 * (places[0] + places[1])
        nodes = self._new_nodes(middle)
        inertia = layer.mass * WIDTH**2 / 12.0
        if layer.bending_stiffness > 0.0:
            self._slab(layer, nodes, chosen, 1.0, layer.body, ("z", "rx", "ry"))
            mass = np.tile([inertia], (len(nodes), 1))
            self._add_part(MassPart(f"{layer.body} rolling", nodes[:, None], mass, ("rx",)))
        else:
            mass = np.tile([layer.mass, inertia], (len(nodes), 1))
            self._add_part(MassPart(layer.body, nodes[:, None], mass, ("z", "rx")))
        seats = []
        for place in places:
            seat = self._new_nodes(place)
            arm = place[:, 1] - middle[:, 1]
            ties = [
                Tie((int(i), "z"), ((int(j), "z", 1.0), (int(j), "rx", float(y))))
                for i, j, y in zip(seat, nodes, arm, strict=True)
            ]
            self.model = replace(self.model, ties=(*self.model.ties, *ties))
            seats.append(seat)
        return seats

    def _neighbors(self, nodes: IntArray, chosen: IntArray, panel: float | None = None) -> IntArray:
        """Pairs of nodes of supports one after the other, but for the joints of panels."""
        joined = np.diff(chosen) == 1
        if panel is not None:
            number = np.floor((self._layout.position[chosen] - self._layout.start) / panel)
            joined &= np.diff(number) == 0.0
        return np.column_stack([nodes[:-1][joined], nodes[1:][joined]])

    def _slab(
        self,
        layer: Layer,
        nodes: IntArray,
        chosen: IntArray,
        share: float,
        name: str,
        components: tuple[str, ...],
    ) -> None:
        """Beams from support to support; half a spacing of mass beyond the first and the last."""
        pairs = self._neighbors(nodes, chosen, self._track.panel_length)
        per_length = share * layer.mass / self._track.spacing
        properties = BeamProperties(
            bending_stiffness_y=share * layer.bending_stiffness,
            torsional_stiffness=4.0 * layer.bending_stiffness / (2.0 * (1.0 + _SLAB_RATIO)),
            mass_per_length=per_length,
        )
        self._add_part(BeamPart(name, pairs, properties, components))
        ends = 2 - np.bincount(np.searchsorted(nodes, pairs.ravel()), minlength=len(nodes))
        if np.any(ends):
            mass = np.asarray(0.5 * share * layer.mass * ends[ends > 0], dtype=np.float64)
            self._add_part(MassPart(f"{name} ends", nodes[ends > 0][:, None], mass[:, None]))

    def _mass_part(self, name: str, masses: list[tuple[IntArray, float]]) -> MassPart:
        nodes = np.concatenate([nodes for nodes, _ in masses])
        inertia = np.concatenate([np.full(len(nodes), mass) for nodes, mass in masses])
        return MassPart(name, nodes[:, None], inertia[:, None])
