"""Starts as a relay's motor start report tells them, where there is no recording."""

from math import sqrt

import numpy as np

from core.machines.parameters import Motor
from core.quality import rated_current_A
from core.relay_reports.motor_starts import StartReport
from core.starts.errors import NoStartError
from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart, StartCurve
from core.starts.stress import start_stress

FEWEST_POINTS = 3


def reported_start(report: StartReport, motor: Motor) -> ExaminedStart:
    """Return a start by its relay's report.

    The report has rms currents and voltages at intervals, and no samples. So the crest is that of a current
    without a direct part, and torque, parameters and the rotor's sideband are not known.

    Parameters
    ----------
    report : StartReport
        What the relay tells.
    motor : Motor
        Nameplate, parameters and limits of the motor.

    Returns
    -------
    ExaminedStart
        Figures and heating of the start.

    Raises
    ------
    NoStartError
        If the report has no curve, or times that do not go evenly.
    """
    times_s, current_A = report.curve_time_s, report.curve_current_A
    if times_s.size < FEWEST_POINTS:
        raise NoStartError(
            "motor start report",
            "curve",
            expected=f"at least {FEWEST_POINTS} points",
            found=str(times_s.size),
        )
    step_s = float(np.median(np.diff(times_s)))
    if not step_s > 0.0 or not np.allclose(np.diff(times_s), step_s, rtol=0.05):
        raise NoStartError(
            "motor start report", "times", expected="one step after the other, all alike", found="others"
        )
    lasts_s = report.duration_s
    over_s = float(times_s[-1] - times_s[0]) + step_s if lasts_s is None else lasts_s
    during = times_s - times_s[0] < over_s - 0.25 * step_s  # times are rounded
    after_A = current_A[~during]
    peak_A = float(current_A.max()) if report.peak_current_A is None else report.peak_current_A
    voltage_V = report.curve_voltage_V
    lowest_V = report.lowest_voltage_V
    if lowest_V is None and voltage_V is not None:
        lowest_V = float(voltage_V[during].min())
    figures = MotorStart(
        is_from_rest=True,
        acceleration_s=lasts_s,
        peak_current_A=peak_A,
        crest_current_A=sqrt(2.0) * peak_A,
        running_current_A=float(after_A.mean()) if after_A.size else None,
        lowest_voltage_V=lowest_V,
        i2t_A2s=float(np.sum(current_A[during] ** 2)) * step_s,
        i2t_over_s=over_s,
        rated_current_A=rated_current_A(motor.nameplate),
        rated_voltage_V=motor.nameplate.rated_voltage_V,
        curve=StartCurve(
            first_s=float(times_s[0]),
            step_s=step_s,
            current_A=tuple(map(float, current_A)),
            voltage_V=None if voltage_V is None else tuple(map(float, voltage_V)),
        ),
    )
    return ExaminedStart(
        figures,
        stress=start_stress(figures, motor),
        remark="from the relay's motor start report: no samples, so no torque and no parameters",
    )
