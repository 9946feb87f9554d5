"""The lower sideband's path through simulated starts, and whether the running motor says the same."""

from dataclasses import replace
from math import log10

import pytest

from core.commissioning.start_detection import start_of
from core.machines.parameters import Motor
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.start_finding import StartSideband, agreement
from core.rotor.starts import start_sideband
from core.starts.measuring import measure_start
from testing.machines.motors import LARGE, REFERENCE
from testing.machines.starts import StartRecord, with_parameters


def heavy(motor: Motor) -> Motor:
    return with_parameters(motor, inertia_kgm2=4.0 * motor.parameters.inertia_kgm2)


def sideband(motor: Motor, record: StartRecord) -> StartSideband:
    recording = record.of(motor)
    start = start_of(recording, motor.nameplate, motor.channels)
    figures = measure_start(recording, motor)
    return start_sideband(
        start.air_gap(motor.parameters), motor.parameters, figures.acceleration_s or figures.i2t_over_s
    )


@pytest.mark.parametrize("motor", [heavy(REFERENCE), heavy(LARGE)], ids=lambda motor: motor.name)
def test_a_broken_bar_shows_with_its_share(motor: Motor) -> None:
    found = sideband(motor, StartRecord(0.4, 2.0, snr_db=40.0, unbalance=0.01, broken_bars=1 / 28, seed=1))

    assert found.state is RotorState.FAULT
    assert found.severity_dB_ci95 is not None
    low, high = found.severity_dB_ci95
    assert low is not None
    assert low - 0.5 < 20.0 * log10(1 / 28) < high


def test_more_bars_show_more() -> None:
    found = [
        sideband(heavy(REFERENCE), StartRecord(0.4, 2.0, snr_db=40.0, broken_bars=bars / 28))
        for bars in (0.5, 1, 2)
    ]

    levels = [one.severity_dB for one in found if one.severity_dB is not None]
    assert levels == sorted(levels)
    assert len(levels) == 3


@pytest.mark.parametrize("unbalance", [0.0, 0.02])
@pytest.mark.parametrize("load", [0.1, 0.6])
def test_a_healthy_cage_shows_none(load: float, unbalance: float) -> None:
    found = sideband(heavy(REFERENCE), StartRecord(load, 2.0, snr_db=40.0, unbalance=unbalance, seed=5))

    assert found.state is RotorState.HEALTHY
    assert found.detection_limit_dB is not None
    assert found.detection_limit_dB < -29.0


def test_a_quick_start_cannot_tell() -> None:
    found = sideband(LARGE, StartRecord(0.1, 1.0, broken_bars=3 / 28))

    assert found.state is RotorState.UNSUPPORTED


STARTED = StartSideband(RotorState.FAULT, -22.0, (-25.0, -20.0), -35.0, 12, ("",))
RUNNING = RotorFinding(
    RotorState.FAULT, -40.0, -45.0, -23.0, (-24.0, -22.0), -35.0, 0.02, 0.7, 5, 10.0, None, ()
)
WELL = {"state": RotorState.HEALTHY, "severity_dB": -50.0}


@pytest.mark.parametrize(
    ("running", "start", "agrees"),
    [
        (RUNNING, STARTED, True),
        (replace(RUNNING, state=RotorState.HEALTHY, severity_dB=-50.0), STARTED, False),
        (RUNNING, replace(STARTED, state=RotorState.HEALTHY, severity_dB=None), False),
        (
            replace(RUNNING, severity_dB=-34.0),
            replace(STARTED, state=RotorState.HEALTHY, severity_dB=None, detection_limit_dB=-30.0),
            None,
        ),
        (replace(RUNNING, state=RotorState.UNSUPPORTED), STARTED, None),
    ],
    ids=["both ill", "start alone", "running alone", "below the start's limit", "one cannot tell"],
)
def test_both_answers_are_compared(running: RotorFinding, start: StartSideband, agrees: bool | None) -> None:
    told, words = agreement(running, start)

    assert told is agrees
    assert words
