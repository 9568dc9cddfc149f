"""The code in the page on section forces runs."""

import re
from pathlib import Path

PAGE = (Path(__file__).parents[2] / "docs" / "theory" / "section-forces.md").read_text(encoding="utf-8")


def test_code_runs():
    (block,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(compile(block, "section-forces.md", "exec"), {})


def test_case_keys_are_those_of_the_schema():
    from axlespan.study import schema

    known = schema()["$defs"]["Output"]["properties"]
    (block,) = re.findall(r"```yaml\n(.*?)```", PAGE, flags=re.DOTALL)
    keys = re.findall(r"^  (\w+):", block, flags=re.MULTILINE)
    assert keys == ["sensors", "section_forces", "stresses", "envelopes", "fields"]
    assert set(keys) <= set(known)


def test_names_of_the_file_are_those_of_the_program():
    import axlespan as asp
    from axlespan.interaction.extras import SECTION_VARIABLES, extra_variables

    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=4
    )
    train = asp.Train.of(asp.vehicles.axle_loads(loads=[1e5], positions=[0.0]))
    result = asp.simulate(
        asp.Crossing(bridge, train, speed=20.0), time_step=1e-2, steps=5, envelopes=["moment"], fields=5
    )
    names = [*SECTION_VARIABLES, *(name for name in extra_variables(result) if "contact" not in name)]
    for name in names:
        short = name.replace("envelope_moment_smallest", "…_smallest")
        shown = "…_largest_time" if name == "envelope_moment_largest_time" else short
        assert f"`{shown}`" in PAGE, name
