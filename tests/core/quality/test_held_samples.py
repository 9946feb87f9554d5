"""Held samples are told before anything that follows from them, and nothing else is taken for them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.diagnosis.stator import diagnose
from core.quality.samples import sampled_slowly
from core.recordings import Recording
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running
from tests.core.diagnosis.spoiling import CURRENTS, edited, pulsed


@cache
def steady(rate_hz: float = 10_000.0, noise: float = 0.003, frequency_hz: float = 50.0) -> Recording:
    return recording(
        running(REFERENCE, 0.6), noise=noise, sample_rate_hz=rate_hz, seconds=0.3, frequency_hz=frequency_hz
    )


def held(record: Recording, samples: float, *, steps: int = 0, scale: float = 1.0) -> Recording:
    """Every so many samples one is taken, by a converter of so many steps, of any scale."""
    count = record.samples.shape[1]
    taken = np.ceil(np.floor(np.arange(count) / samples) * samples).astype(int)
    return quantised(replace(record, samples=scale * record.samples[:, taken]), steps)


def quantised(record: Recording, steps: int) -> Recording:
    if not steps:
        return record
    step = np.ptp(record.samples, axis=1, keepdims=True) / steps
    return replace(record, samples=step * np.round(record.samples / step))


@pytest.mark.parametrize("steps", [0, 200, 4096])
@pytest.mark.parametrize("scale", [1.0, 0.003])
@pytest.mark.parametrize("currents_only", [False, True])
@pytest.mark.parametrize(("rate_hz", "hold"), [(51_200.0, 128 / 3), (10_000.0, 43.0), (5_000.0, 4.0)])
def test_a_record_of_held_samples_says_so_first(
    rate_hz: float, hold: float, currents_only: bool, scale: float, steps: int
) -> None:
    """Also with 97.7 % held, of secondary values, and where no current or frequency would be found."""
    record = held(steady(rate_hz), hold, steps=steps, scale=scale)
    (reason,) = diagnose(record, REFERENCE, currents_only=currents_only).reasons
    assert reason.startswith("held samples")
    assert "sampled more slowly than the file says" in reason


def test_held_samples_come_before_a_frequency_and_a_start() -> None:
    odd = held(steady(frequency_hz=37.0), 43.0)
    assert diagnose(odd, REFERENCE).reasons[0].startswith("held samples")
    starting = edited(steady(), CURRENTS, np.repeat([0.0, 1.0], 1_500))
    assert diagnose(held(starting, 43.0), REFERENCE).reasons[0].startswith("held samples")


def off(record: Recording, deviation_steps: float) -> Recording:
    """A motor that stands, seen through converters whose noise is so many of their steps."""
    noise = np.random.default_rng(5).standard_normal(record.samples.shape)
    return replace(record, samples=np.round(deviation_steps * noise))


RESTING = {
    "nothing at all": lambda: edited(steady(), list(range(6)), 0.0),
    "a motor that stands": lambda: off(steady(), 0.4),
    "a noisier one": lambda: off(steady(), 1.0),
    "a much noisier one": lambda: off(steady(), 4.0),
    "a coarse converter": lambda: quantised(steady(), 20),
    "a coarse and fast one": lambda: quantised(steady(51_200.0), 60),
    "a fine one": lambda: quantised(steady(), 4096),
    "few steps without noise": lambda: quantised(steady(20_000.0, 0.0), 12),
    "a start from rest": lambda: edited(steady(), list(range(6)), np.repeat([0.0, 1.0], 1_500)),
    "a coarse start": lambda: quantised(edited(steady(), list(range(6)), np.repeat([0.0, 1.0], 1_500)), 100),
    "a slow record": lambda: quantised(steady(600.0), 4096),
    "a drive": lambda: pulsed(steady(), 4_000.0),
}  # fmt: skip


@pytest.mark.parametrize("name", RESTING)
def test_what_rests_otherwise_is_not_held(name: str) -> None:
    record = RESTING[name]()
    for rows in (slice(0, 3), slice(3, 6)):
        assert not list(sampled_slowly(record.channels[rows], record.samples[rows]))
