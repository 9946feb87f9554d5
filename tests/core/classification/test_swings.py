"""Swings of the load, by findings that are given, without a record."""

import pytest

from core.classification.swings import pulsation_block
from core.rotor.finding import LOAD_OSCILLATION, RotorFinding, RotorState, decibels
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding

NO_GAP = EccentricityFinding.untold("a record too short")
QUIET = PulsationFinding(
    load_torque=0.001,
    noise=0.0002,
    frequency_hz=6.0,
    load_torque_deviation=0.0003,
    detection_limit=0.001,
    reasons=(),
)
OSCILLATES = f"{LOAD_OSCILLATION}: the load's torque swings at twice the slip"


def _evidence(state: RotorState, load_torque: float | None, *reasons: str) -> float:
    rotor = RotorFinding(
        state=state,
        lower_sideband_dB=-30.0,
        upper_sideband_dB=-35.0,
        severity_dB=-60.0,
        severity_dB_ci95=(-65.0, -56.0),
        detection_limit_dB=-55.0,
        slip=0.02,
        load_level=0.5,
        load_bin=5,
        duration_s=1.28,
        load_oscillation_dB=None if load_torque is None else decibels(load_torque),
        reasons=reasons,
    )
    block = pulsation_block(rotor, NO_GAP, QUIET)
    assert block is not None
    (ratio,) = block.log_likelihood.values()
    return ratio


@pytest.mark.parametrize("state", RotorState)
def test_a_load_that_swings_at_twice_the_slip_counts_whatever_the_rotor_is(state: RotorState) -> None:
    """A record of 64 cycles has too few of a slow swing for the search elsewhere."""
    assert _evidence(state, 0.05, OSCILLATES) > 20.0


@pytest.mark.parametrize("state", [RotorState.HEALTHY, RotorState.WATCH, RotorState.FAULT])
def test_an_inertia_that_is_wrong_makes_no_swing(state: RotorState) -> None:
    assert _evidence(state, 0.05) < -2.0


def test_a_record_that_cannot_tell_says_nothing_of_twice_the_slip() -> None:
    untold = _evidence(RotorState.UNSUPPORTED, None)
    assert _evidence(RotorState.UNSUPPORTED, 0.05) == pytest.approx(untold)
