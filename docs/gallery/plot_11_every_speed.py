r"""
Every speed of a line
=====================

A study varies a case: here speeds and trains. Crossings of one structure go side by side over one factorization; the
table of all scenarios is kept in a folder, and ``Answers`` reads envelopes from it.
"""

from tempfile import mkdtemp

import axlespan as asp

study = asp.Study(
    {
        "structure": {
            "kind": "simple-span",
            "length": "20 m",
            "youngs_modulus": "34 GPa",
            "second_moment": "0.75 m^4",
            "mass_per_length": "14 t/m",
            "elements": 10,
            "damping": {"kind": "rayleigh", "ratio": "1 %", "frequencies": ["6 Hz", "24 Hz"]},
        },
        "train": [{"vehicle": "hslm-a1"}],
        "crossing": {"speed": "200 km/h"},
        "analysis": {"time_step": "5 ms"},
        "output": {"line": 11},
    },
    {
        "train.0.vehicle": ["hslm-a1", "hslm-a5"],
        "crossing.speed": {"from": "160 km/h", "to": "360 km/h", "step": "10 km/h"},
    },
    passage={"after": "0.5 s"},
)
outcome = study.run(mkdtemp())
print(outcome)

# %%

answers = study.answers()
asp.plot.over_speed(answers, "line_acceleration_max_m_per_s2")
