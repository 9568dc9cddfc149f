"""Track: a rail on an elastic foundation."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.reference import SleeperTrack, WinklerBeam
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import GRAVITY, axle

_HETENYI = "M. Hetényi, Beams on Elastic Foundation (1946); L. Frýba (1999) for the moving force"


@case("rail-on-springs", "A rail on an elastic foundation", _HETENYI)
def rail_on_springs() -> list[Row]:
    """A rail 60E1 on 50 MN/m2 under 85 kN that stand, and that run at half the critical speed (385 m/s).

    Springs at every node. Standing: nodes every 0.05 m, the moment from the curvature of the element beside the
    force; lumped springs lack k w h^2 / 12 of it. Running: nodes every 0.2 m; the force gathers speed smoothly over
    50 m and is looked at 3 m to both sides of a point 12 m further on.
    """
    rail = WinklerBeam(210e9 * 3.0383e-5, foundation_modulus=50e6, mass_per_length=60.21)
    force = 85e3
    size, length = 0.05, 20.0
    inside = np.array([0.0, 1.0, 2.0, 3.0]) / 3.0 * size
    sensors = {f"s{i}": 0.5 * length + float(x) for i, x in enumerate(inside)}
    sensors["aside"] = 0.5 * length + 1.7
    standing = asp.Crossing(_rail(rail, length, size), axle(force), speed=0.0, start=0.5 * length)
    w = asp.simulate(standing, time_step=1e-3, steps=1, sensors=sensors).sensor_displacement[0]
    curvature = 2.0 * np.polyfit(inside, w[:4], 3)[1]
    moment = rail.bending_stiffness * curvature
    aside = float(rail.deflection(1.7, force))
    static = rail.static_deflection(force)
    rows = [
        value("standing: w0 = P beta / 2 k", "mm", 1.00562, -1e3 * w[0], 1e-5, "six digits, as printed"),
        value("standing: M0 = P / 4 beta", "kNm", 17.9616, 1e-3 * moment, 1e-3, "six digits, as printed"),
        value(
            "standing: w 1.7 m aside",
            "mm",
            1e3 * aside,
            1e3 * w[4],
            1e-5,
            "(R26)",
            scale=1e3 * static,
            of="w0",
        ),
    ]
    return [*rows, _running(rail, force)]


def _rail(rail: WinklerBeam, length: float, size: float) -> asp.Structure:
    """A rail on springs at its nodes."""
    x = np.linspace(0.0, length, round(length / size) + 1)
    share = np.where((x == 0.0) | (x == length), 0.5, 1.0) * size
    springs = [
        SupportAt(float(at), (), stiffness={"z": rail.foundation_modulus * float(part)})
        for at, part in zip(x, share, strict=True)
    ]
    return asp.bridges.simple_span(
        length=length,
        youngs_modulus=210e9,
        second_moment=3.0383e-5,
        mass_per_length=rail.mass_per_length,
        elements=len(x) - 1,
        supports=springs,
    )


def _running(rail: WinklerBeam, force: float) -> Row:
    """The trough under a force at half the critical speed, as it passes a point."""
    length, start, run_up, point = 80.0, 5.0, 50.0, 67.0
    speed = 0.5 * rail.critical_speed
    rise = 2.0 * run_up / speed  # [s]
    part = np.linspace(0.0, 1.0, 81)
    speeds = speed * (10.0 * part**3 - 15.0 * part**4 + 6.0 * part**5)
    duration = rise + (point + 3.0 - start - run_up) / speed
    crossing = asp.Crossing(
        _rail(rail, length, 0.2),
        axle(force),
        speed_history=np.column_stack([rise * part, speeds]).tolist(),
        start=start,
    )
    step = 1e-4
    result = asp.simulate(crossing, time_step=step, steps=int(duration / step), sensors={"point": point})
    ahead = result.contact_position[:, 0] - point
    window = np.flatnonzero(np.abs(ahead) < 3.0)
    return history(
        "running: trough at half the critical speed",
        "mm",
        ahead[window],
        1e3 * rail.deflection(ahead[window], force, speed),
        1e3 * result.sensor_displacement[window, 0],
        1e-3,
        "(R26), steady state",
    )


@case("ballasted-track", "A ballasted track at rest, and a wheel that settles on it", f"{_HETENYI}; statics")
def ballasted_track() -> list[Row]:
    """The track of Zhai (two rails CHN60, sleepers at 0.6 m) under 150 kN, and a wheel that runs on it.

    At rest: over a sleeper and between two, against dense matrices written out by hand. Running: 1.5 t with 8 t on
    1.2 MN/m and 20 kNs/m at 30 m/s, steps of 0.5 ms; over ten sleepers at the end of 60 m the mean of the contact
    force is the weight, and what is left swings with the sleepers. The rail under it is as deep as at rest.
    """
    bays = 150
    track = asp.bridges.ballasted_track("zhai-2004")
    line = asp.bridges.track_on_ground(track, bays * 0.6)
    own = SleeperTrack(2.0 * 2.059e11 * 3.217e-5, 0.6, 130e6, 275.5e6, 155e6, 156.8e6, bays)
    load, rows = 150e3, []
    for name, node in (("over a sleeper", bays + 1), ("between sleepers", bays)):
        at = 0.3 * node
        standing = asp.Crossing(line, axle(load), speed=0.0, start=at)
        result = asp.simulate(standing, time_step=1e-3, steps=1, sensors={"there": at})
        found, expected = 1e3 * result.sensor_displacement[0, 0], 1e3 * own.deflection(load, node)
        rows.append(value(f"at rest, {name}", "mm", expected, found, 1e-6, "matrices by hand"))
    wheel = asp.vehicles.sprung_mass(mass=8e3, stiffness=1.2e6, damping=20e3, unsprung_mass=1500.0)
    speed, step = 30.0, 5e-4
    crossing = asp.Crossing(line, asp.Train.of(wheel), speed=speed, start=0.0)
    result = asp.simulate(crossing, time_step=step, steps=round(69.0 / speed / step))
    since = result.time > 63.0 / speed  # ten sleepers, 400 steps
    force = result.contact_force[since, 0]
    weight = 9500.0 * GRAVITY
    depth = 1e3 * result.at("vehicle_displacement", "1.wheel1.z")[since]
    still = 0.5e3 * (own.deflection(weight, bays) + own.deflection(weight, bays + 1))
    swing = float(np.abs(force - force.mean()).max() / weight)
    return [
        *rows,
        value("running: mean contact force", "kN", 1e-3 * weight, 1e-3 * force.mean(), 1e-3, "weight"),
        value("running: largest swing over the weight", "-", 0.0, swing, 1e-2, "sleeper passing", scale=1.0),
        value(
            "running: mean depth of the wheel", "mm", still, depth.mean(), 1e-2, "matrices by hand, at rest"
        ),
    ]


CASES = (rail_on_springs, ballasted_track)
