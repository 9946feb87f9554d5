"""Recordings of every kind that nobody meant to make: the diagnosis answers or raises what it documents, and
neither warns nor hangs nor calls a healthy motor faulty."""

import json
import math
import resource
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from core.diagnosis.errors import DiagnosisError
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Diagnosis, Verdict
from core.recordings import Channel, Quantity, Recording, RecordingError
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from tests.core.diagnosis.spoiling import clipped, edited, exchanged, frozen, repeated

CHANNELS = recording(running(REFERENCE, 0.5), seconds=0.01).channels
HEALTHY = {motor.name: recording(running(motor, 0.6), noise=0.003, seconds=0.3) for motor in ALL}
QUICK = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])

magnitudes = st.sampled_from([0.0, 5e-324, 1e-300, 1e-12, 1e-3, 1.0, 300.0, 1e9, 1e150, 1.7e308])
values = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True, width=64),
    st.sampled_from([0.0, -0.0, math.nan, math.inf, -math.inf, 1.0, 2.0**63, -(2.0**63), 32767.0, -32768.0]),
)
rates = st.sampled_from([600.0, 800.0, 960.0, 1_600.0, 8_000.0, 10_000.0, 50_000.0])
absurd_rates = st.floats(allow_nan=True, allow_infinity=True)


def outcome(record: Recording, *, currents_only: bool = False) -> Diagnosis | None:
    """The diagnosis, None where the recording was rejected; a refusal has its reason."""
    try:
        result = diagnose(record, REFERENCE, currents_only=currents_only)
    except RecordingError as error:
        assert str(error)  # noqa: PT017 - which error it is, is the question
        return None
    refused = result.verdict is Verdict.UNDIAGNOSABLE
    assert refused == any(not finding.passed for finding in result.quality)
    assert refused == (result.mu_f is None)
    assert result.reasons
    assert all(math.isfinite(one.value) and math.isfinite(one.limit) for one in result.quality)
    assert json.loads(json.dumps(result.as_dict(), allow_nan=False))["verdict"] == str(result.verdict)
    return result


@QUICK
@given(arrays(np.float64, st.tuples(st.just(6), st.integers(0, 40)), elements=values), rates, st.booleans())
def test_any_few_samples(samples: NDArray[np.float64], rate: float, currents_only: bool) -> None:
    result = outcome(Recording(samples, rate, 0, CHANNELS), currents_only=currents_only)
    assert result is not None
    assert result.verdict is Verdict.UNDIAGNOSABLE


@QUICK
@given(
    arrays(np.float64, (6, 16), elements=values), st.integers(20, 200), st.one_of(rates, absurd_rates),
    st.booleans(),
)  # fmt: skip
def test_any_values_repeated_to_a_long_record(
    block: NDArray[np.float64], times: int, rate: float, currents_only: bool
) -> None:
    outcome(Recording(np.tile(block, times), rate, 0, CHANNELS), currents_only=currents_only)


@QUICK
@given(
    st.lists(magnitudes, min_size=6, max_size=6), magnitudes, rates, st.floats(1.0, 400.0), st.integers(0, 99)
)
@example([1.0] * 3 + [300.0] * 3, 0.0, 10_000.0, 50.0, 0)
@example([1.7e308] * 6, 1.7e308, 10_000.0, 50.0, 0)
@example([5e-324] * 6, 0.0, 10_000.0, 50.0, 0)
def test_sines_and_noise_of_any_size(
    sizes: list[float], noise: float, rate: float, frequency_hz: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    angle = 2 * np.pi * frequency_hz * np.arange(round(0.15 * rate)) / rate
    phases = random.choice([0.0, 2.0, 4.0], 6)[:, None] * np.pi / 3
    sines = np.array(sizes)[:, None] * np.sin(angle - phases)
    samples = sines + np.clip(random.standard_normal(sines.shape) / 4, -1, 1) * min(noise, 9e306)
    outcome(Recording(np.clip(samples, -1.7e308, 1.7e308), rate, 0, CHANNELS))


@pytest.mark.parametrize(
    "dtype", [np.int8, np.int16, np.int64, np.uint64, np.float32, np.bool_, np.complex128]
)
def test_numbers_of_any_kind_at_their_extremes(dtype: type) -> None:
    good = HEALTHY["reference"].samples
    kind = np.dtype(dtype).kind
    extremes = (np.iinfo(dtype).min, np.iinfo(dtype).max) if kind in "iu" else (0, 1)
    alternating: NDArray[Any] = np.resize(np.array(extremes, dtype=dtype), good.shape)
    constant: NDArray[Any] = np.full(good.shape, extremes[1], dtype=dtype)
    rounded: NDArray[Any] = np.abs(good).astype(dtype)
    for samples in (alternating, constant, rounded):
        outcome(Recording(samples, 10_000.0, 0, CHANNELS))


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf])
def test_no_rate_is_a_recording_error(rate: float) -> None:
    with pytest.raises(RecordingError, match="sample rate: expected more than 0 Hz"):
        diagnose(replace(HEALTHY["reference"], sample_rate_hz=rate), REFERENCE)


@QUICK
@given(
    st.lists(
        st.builds(
            Channel, st.sampled_from(["IA", "IB", "VA", "", "x" * 300]), st.sampled_from(list(Quantity)),
            st.sampled_from(["a", "b", "c", "n", "ab", "bc", "ca", "", None]),
            st.sampled_from(["A", "V", "kA", ""]), st.one_of(st.none(), st.floats(allow_nan=True)),
        ),
        max_size=8,
    ),
    st.booleans(),
)  # fmt: skip
def test_any_channels(channels: list[Channel], currents_only: bool) -> None:
    samples = np.ones((len(channels), 3_000))
    outcome(Recording(samples, 10_000.0, 0, tuple(channels)), currents_only=currents_only)


@pytest.mark.parametrize("full_scale", [0.0, -1.0, math.nan, math.inf, 5e-324])
def test_any_full_scale(full_scale: float) -> None:
    good = HEALTHY["reference"]
    channels = tuple(replace(channel, full_scale=full_scale) for channel in good.channels)
    outcome(replace(good, channels=channels))


def test_ten_million_samples_take_the_time_of_their_end() -> None:
    """Only the last second is looked at: neither time nor memory grows with the record."""
    end = recording(running(REFERENCE, 0.5, fault=Fault(0.05, 1)), noise=0.003, seconds=1.3)
    samples: NDArray[Any] = np.zeros((6, 10_000_000), dtype=np.float32)
    samples[:, -13_000:] = end.samples
    alone = diagnose(end, REFERENCE)
    before, begun = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    result = diagnose(Recording(samples, 10_000.0, 0, CHANNELS), REFERENCE)
    assert time.process_time() - begun < 5.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # kB
    assert result.verdict is Verdict.FAULT
    assert result.phase == "b"
    assert result.mu_f == pytest.approx(alone.mu_f, rel=1e-3)


def test_ten_million_samples_of_a_second_are_refused() -> None:
    samples: NDArray[Any] = np.zeros((6, 10_000_000), dtype=np.float32)
    result = diagnose(Recording(samples, 1e7, 0, CHANNELS), REFERENCE)
    assert any(reason.startswith("sample rate") for reason in result.reasons)


@st.composite
def damaged(draw: st.DrawFn) -> tuple[str, Recording]:
    """A healthy record that one to three mishaps befell, one after the other."""
    name = draw(st.sampled_from(sorted(HEALTHY)))
    record = HEALTHY[name]
    n = record.samples.shape[1]
    for _ in range(draw(st.integers(1, 3))):
        row = draw(st.integers(0, 5))
        first = draw(st.integers(0, n - 1))
        last = min(n, first + draw(st.integers(1, 600)))
        match draw(
            st.sampled_from(["drop", "lose", "clip", "swap", "scale", "reverse", "hold", "repeat", "burst"])
        ):
            case "drop":
                record = frozen(record, [row], first, last, 0.0)
            case "lose":
                kept = np.r_[0:first, last:n]
                record = replace(record, samples=record.samples[:, np.resize(kept, n)])
            case "clip":
                record = clipped(record, row, draw(st.floats(0.2, 0.95)))
            case "swap":
                other = draw(st.integers(0, 5))
                record = exchanged(record, [row, other], [other, row])
            case "scale":
                factor = draw(st.sampled_from([1e-3, 0.1, 0.2, 0.5, 0.58, 0.75, 1.3, 1.73, 2.0, 10.0, 1e3]))
                rows = draw(st.sampled_from([[row], [0, 1, 2], [3, 4, 5]]))
                record = edited(record, rows, factor)
            case "reverse":
                record = edited(record, [row], -1.0)
            case "hold":
                record = frozen(record, [row], first, last)
            case "repeat":
                record = repeated(record, [row], draw(st.integers(2, 40)))
            case "burst":
                record = frozen(record, [row], first, last, math.nan)
    return name, record


@settings(QUICK, max_examples=80)
@given(damaged())
def test_damage_is_no_fault(case: tuple[str, Recording]) -> None:
    name, record = case
    (motor,) = [one for one in ALL if one.name == name]
    assert diagnose(record, motor).verdict is not Verdict.FAULT


def test_a_baseline_from_spoilt_records_is_refused() -> None:
    with pytest.raises(DiagnosisError, match="not fit for a baseline: missing samples"):
        learn_baseline([frozen(HEALTHY["reference"], [0], 5, 9, math.nan)] * 3, REFERENCE)
