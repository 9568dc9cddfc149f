"""Records of monitoring systems: sampling, noise, quantization, damage, temperature, and each of them again."""

import numpy as np
import pytest
import xarray as xr
from tests.study.sweep.conftest import BASE

from axlespan.errors import InputError
from axlespan.study.sweep import Study
from axlespan.study.sweep.recording import Recording

STUDY = f"""\
base:
{BASE}\
vary:
  structure.temperature.value: {{distribution: normal, mean: 10, std: 8}}
  structure.damage:
    - []
    - [{{from: 4 m, to: 6 m, stiffness: 0.7}}]
sampling: {{method: latin-hypercube, count: 3, seed: 4}}
passage: {{after: 0.1 s}}
records:
  sampling_rate: 100 Hz
  noise: {{std: 2 mm/s^2}}
  quantization: {{bits: 12, range: 4 m/s^2}}
  seed: 9
""".replace("elements: 6}", "elements: 6, temperature: {value: 10, coefficient: -0.005}}")

STEP = 0.001


def harmonic(frequency, seconds=4.0):
    """A sine that fades in and out."""
    t = np.arange(0.0, seconds + 1e-9, STEP)
    return (np.sin(2.0 * np.pi * frequency * t) * np.sin(np.pi * t / seconds) ** 2)[:, None]


def amplitude(values, frequency, rate, seconds=4.0):
    """Amplitude at a frequency, relative to that of the sine above."""
    t = np.arange(len(values)) / rate
    return 4.0 * abs(np.sum(values[:, 0] * np.exp(-2j * np.pi * frequency * t))) / (rate * seconds)


def test_what_is_below_the_corner_passes_without_delay():
    recording = Recording(100.0)
    for frequency in (1.0, 10.0, 25.0):
        values = harmonic(frequency)
        record = recording.record(values, STEP, 0)
        assert len(record) == 401
        assert record == pytest.approx(values[::10], abs=6e-3)


def test_what_is_above_half_the_rate_is_gone():
    recording = Recording(100.0)
    # Butterworth of order 8 twice: |H|² at 60 Hz with a corner at 40 Hz, (1 + 1.5^16)^-1, a little less digitally
    assert amplitude(recording.record(harmonic(60.0), STEP, 0), 40.0, 100.0) < 1.0 / (1.0 + 1.5**16) * 1.1
    assert amplitude(recording.record(harmonic(90.0), STEP, 0), 10.0, 100.0) < 1e-4
    assert amplitude(recording.record(harmonic(10.0), STEP, 0), 10.0, 100.0) == pytest.approx(1.0, abs=2e-3)


def test_rates_that_are_no_part_of_the_time_steps():
    recording = Recording(37.0)
    t = np.arange(0.0, 4.0 + 1e-9, STEP)
    smooth = np.sin(2.0 * np.pi * 3.0 * t) * np.sin(np.pi * t / 4.0) ** 2
    record = recording.record(smooth[:, None], STEP, 0)[:, 0]
    at = np.arange(len(record)) / 37.0
    assert record == pytest.approx(np.sin(2.0 * np.pi * 3.0 * at) * np.sin(np.pi * at / 4.0) ** 2, abs=1e-4)


def test_noise_and_quantization():
    still = np.zeros((40_001, 2))
    record = Recording(200.0, noise=0.02, seed=3).record(still, STEP, 5)
    assert record.std() == pytest.approx(0.02, rel=0.02)
    assert abs(np.corrcoef(record.T)[0, 1]) < 0.05
    again = Recording(200.0, noise=0.02, seed=3).record(still, STEP, 5)
    other = Recording(200.0, noise=0.02, seed=3).record(still, STEP, 6)
    assert np.array_equal(record, again) and not np.array_equal(record, other)
    coarse = Recording(200.0, noise=0.02, seed=3, bits=8, limit=1.0).record(still, STEP, 5)
    unit = 2.0 / 256
    assert np.abs(coarse - record).max() <= 0.5 * unit + 1e-12
    assert np.array_equal(np.round(coarse / unit) * unit, coarse)
    loud = Recording(200.0, bits=8, limit=0.01).record(harmonic(5.0), STEP, 0)
    assert loud.max() == pytest.approx(0.01 * 127 / 128) and loud.min() == -0.01
    share = Recording(1000.0, noise_share=0.1).record(harmonic(5.0), STEP, 0) - harmonic(5.0)
    assert share.std() == pytest.approx(0.1 * harmonic(5.0).std(), rel=0.05)


def test_any_record_can_be_made_again_alone(study_file, tmp_path):
    study = Study.load(study_file(STUDY))
    study.run(tmp_path / "out")
    table = study.table()
    assert len(table) == 6 and table["structure.damage"].tolist()[:3] == ["[]"] * 3
    for number in (1, 5):
        row = table.loc[number]
        with xr.open_dataset(tmp_path / "out" / "records" / row["records"]) as data:
            kept = data.sensor_acceleration.sel(scenario=number).dropna("time").values
            assert float(data.time[1]) == 0.01
        scenario = study.scenario(number)
        again = scenario.record()
        assert np.abs(again - kept).max() <= 8.0 / 2**12 + 1e-12  # equal, or next to each other at a rounding
        assert np.mean(again == kept) > 0.99
        assert scenario.provenance == row["provenance"]
        assert scenario.case.structure.temperature.value == pytest.approx(row["structure.temperature.value"])
    assert table["provenance"].nunique() == 6
    other = Study.load(study_file(STUDY.replace("seed: 9", "seed: 10")))
    assert other.scenario(1).provenance != table.loc[1, "provenance"]


def test_damage_softens_and_heat_too(study_file):
    study = Study.load(study_file(STUDY))
    whole, damaged = study.scenario(0), study.scenario(3)
    assert whole.case.structure.damage == () and damaged.case.structure.damage[0].stiffness == 0.7
    deepest = [one.run().sensor_displacement.min() for one in (whole, damaged)]
    assert deepest[1] < 1.05 * deepest[0]


def test_a_rate_beyond_the_time_steps_is_refused(study_file):
    with pytest.raises(InputError, match=r"records.sampling_rate = 500 Hz: must be at most 250 Hz"):
        Study.load(study_file(STUDY.replace("100 Hz", "500 Hz"))).trial(timed=False)
