"""Starts by the relay's own report, and compared with one another."""

from dataclasses import replace

import numpy as np
import pytest

from core.relay_reports.motor_starts import StartReport
from core.starts.changes import compare_starts
from core.starts.compared import ChangeState, StartCause
from core.starts.errors import NoStartError
from core.starts.reported import reported_start
from testing.machines.motors import MEDIUM

TIMES_S = np.linspace(0.0, 1.9, 20)
REPORT = StartReport(
    time_ns=0,
    duration_s=1.5,
    peak_current_A=95.0,
    lowest_voltage_V=371.0,
    curve_time_s=TIMES_S,
    curve_current_A=np.where(TIMES_S < 1.45, 90.0, 10.0),
    curve_voltage_V=np.where(TIMES_S < 1.45, 375.0, 400.0),
)


def test_a_report_has_the_figures_of_a_start() -> None:
    found = reported_start(REPORT, MEDIUM)

    assert found.figures.acceleration_s == 1.5
    assert found.figures.i2t_A2s == pytest.approx(15 * 0.1 * 90.0**2)
    assert found.figures.running_current_A == pytest.approx(10.0)
    assert found.figures.mean_current_A == pytest.approx(90.0)
    assert found.figures.peak_current_A == 95.0
    assert found.stress is not None
    assert found.torque is None
    assert found.remark is not None


def test_a_start_that_did_not_end_has_no_time() -> None:
    found = reported_start(replace(REPORT, duration_s=None, peak_current_A=None), MEDIUM)

    assert found.figures.acceleration_s is None
    assert found.figures.peak_current_A == pytest.approx(90.0)
    assert found.figures.running_current_A is None


def test_reports_tell_a_weak_supply_and_not_load_from_rotor() -> None:
    before = [reported_start(REPORT, MEDIUM)] * 3
    slow = replace(REPORT, duration_s=1.9, curve_voltage_V=np.full(20, 375.0))
    weak = replace(slow, curve_voltage_V=np.full(20, 340.0))

    slower = compare_starts([reported_start(slow, MEDIUM)], before)
    weaker = compare_starts([reported_start(weak, MEDIUM)], before)

    assert slower.state is ChangeState.NOT_TOLD_APART
    assert set(slower.possible) == {StartCause.LOAD, StartCause.ROTOR, StartCause.WARMTH}
    assert weaker.causes == (StartCause.SUPPLY,)


@pytest.mark.parametrize("times", [TIMES_S[:2], np.array([0.0, 0.1, 0.5, 0.6])], ids=["short", "uneven"])
def test_a_report_without_an_even_curve_is_refused(times: np.ndarray) -> None:
    with pytest.raises(NoStartError):
        reported_start(replace(REPORT, curve_time_s=times, curve_current_A=np.ones(times.size)), MEDIUM)
