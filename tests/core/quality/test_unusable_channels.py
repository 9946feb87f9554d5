"""Channels that are no measurement of three phases, and what an engineer would say of them."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.acceptance import accept
from core.quality.supply import _scaling_hint
from core.recordings import Recording
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running

SOUND = recording(running(REFERENCE, 0.6), noise=0.002)


def first_reason(record: Recording, *, currents_only: bool = False) -> str:
    quality = accept(record, REFERENCE, currents_only=currents_only).quality
    return next(one.message for one in quality if not one.passed)


@pytest.mark.parametrize(
    ("rows", "currents_only"),
    [((0, 1, 2), False), ((0, 1), False), ((3, 4, 5), False), ((0, 1, 2), True), ((0, 1), True)],
)
def test_channels_of_the_same_samples_are_named(rows: tuple[int, ...], currents_only: bool) -> None:
    samples = SOUND.samples.copy()
    samples[list(rows)] = samples[rows[0]]
    reason = first_reason(replace(SOUND, samples=samples), currents_only=currents_only)
    assert "the very same samples" in reason
    assert all(repr(SOUND.channels[row].name) in reason for row in rows)


def test_channels_that_measure_nothing_are_no_copies() -> None:
    assert "switched off" in first_reason(replace(SOUND, samples=np.zeros_like(SOUND.samples)))


@pytest.mark.parametrize("share", [0.2, 0.5, 0.86, 1.0, 1.3])
def test_a_hint_without_advice_ends_as_a_sentence(share: float) -> None:
    assert not _scaling_hint(share, REFERENCE.nameplate, ()).rstrip().endswith(";")
