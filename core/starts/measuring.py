"""Measures a recorded start: its duration, its currents, how far the voltage falls, its thermal stress.

All follows from the samples alone, by the definitions below, whatever the motor and its load. A machine model
is not needed. So a start through a soft starter or from star to delta is measured as well.
"""

from math import ceil, sqrt

import numpy as np

from core.commissioning.onset import current_onset, quiet_offset
from core.machines.base import Array
from core.machines.parameters import Motor
from core.quality import rated_current_A
from core.recordings import Recording
from core.signals.clarke import clarke
from core.signals.terminals import Terminals, terminals
from core.starts.errors import NoStartError
from core.starts.figures import MotorStart, StartCurve

MOST_POINTS = 400
"""Points of a curve: a longer start has one for several cycles."""
FEWEST_CYCLES = 3
FALLEN = 0.9
"""Share of the way from the starting to the running current after which the motor is up to speed."""
RUNNING_CYCLES = 5
"""Cycles at the end of the record by which it is told whether the motor runs."""
STEADY = 0.05
"""Share of the greatest current by which that of a motor that runs steadily varies at most."""
RUN_UP = 0.6
"""Share of the greatest current below which that of a motor that is up to speed lies."""


def measure_start(recording: Recording, motor: Motor) -> MotorStart:
    """Measure a start.

    Parameters
    ----------
    recording : Recording
        A recording in which the motor starts.
    motor : Motor
        Nameplate, channel names and ratios of the motor.

    Returns
    -------
    MotorStart
        What it shows.

    Raises
    ------
    RecordingError
        If the recording lacks channels.
    NoStartError
        If it has missing samples, is shorter than three cycles, or has no current.
    """
    measured = terminals(
        recording,
        currents=motor.channels.currents,
        phase_voltages=motor.channels.phase_voltages,
        line_voltages=motor.channels.line_voltages,
        voltage_ratio=motor.transformers.voltage_ratio,
        current_ratio=motor.transformers.current_ratio,
        inside_delta=motor.transformers.inside_delta,
    )
    per_cycle = measured.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    _check(recording.source, measured, per_cycle)
    onset = current_onset(clarke(measured.current_abc), per_cycle)
    first = 0 if onset is None else max(0, round(onset))
    offset = np.zeros((3, 1)) if onset is None else quiet_offset(measured.current_abc, onset, per_cycle)
    squares = np.mean((measured.current_abc - offset)[:, first:] ** 2, axis=0)
    volts = _line_squares(measured)
    if squares.size < FEWEST_CYCLES * per_cycle:
        raise NoStartError(
            recording.source,
            "duration",
            expected=f"at least {FEWEST_CYCLES} cycles after the motor was switched on",
            found=f"{squares.size / per_cycle:.1f}",
        )
    sliding_A = np.sqrt(_sliding_means(squares, round(per_cycle)))
    running_A = _running_current(sliding_A, per_cycle)
    end = None if running_A is None else _end_of_run_up(sliding_A, running_A, per_cycle)
    last = squares.size if end is None else end
    return MotorStart(
        is_from_rest=onset is not None,
        acceleration_s=None if end is None or onset is None else end / measured.sample_rate_hz,
        peak_current_A=float(sliding_A.max()),
        crest_current_A=float(np.abs(measured.current_abc - offset).max()),
        running_current_A=running_A,
        lowest_voltage_V=None if volts is None else _lowest(volts[first : first + last], per_cycle),
        i2t_A2s=float(squares[:last].sum() / measured.sample_rate_hz),
        i2t_over_s=last / measured.sample_rate_hz,
        rated_current_A=rated_current_A(motor.nameplate),
        rated_voltage_V=motor.nameplate.rated_voltage_V,
        curve=_curve(squares, None if volts is None else volts[first:], measured.sample_rate_hz, per_cycle),
    )


def _check(source: str, measured: Terminals, per_cycle: float) -> None:
    rows = [measured.current_abc, measured.voltages]
    if not all(np.isfinite(one).all() for one in rows):
        raise NoStartError(source, "samples", expected="a value at every instant", found="missing ones")
    if per_cycle < 4.0:
        raise NoStartError(
            source, "sample rate", expected="at least 4 samples a cycle", found=f"{per_cycle:.1f}"
        )
    if not np.abs(measured.current_abc).max(initial=0.0) > 0.0:
        raise NoStartError(source, "currents", expected="those of a motor that starts", found="none")


def _line_squares(measured: Terminals) -> Array | None:
    """Return the square of the rms voltage line to line that a balanced supply would have, [V^2]."""
    if measured.voltage_ab is None:
        return None
    return np.asarray(np.sum(measured.voltage_ab**2, axis=0))


def _sliding_means(squares: Array, samples: int) -> Array:
    """Return the mean of each stretch of so many samples, by its first one."""
    total = np.concatenate([[0.0], np.cumsum(squares)])
    return np.asarray((total[samples:] - total[:-samples]) / samples).clip(min=0.0)


def _running_current(sliding_A: Array, per_cycle: float) -> float | None:
    """Return the current at the end of the record where the motor runs by then."""
    end = sliding_A[-max(2, round(RUNNING_CYCLES * per_cycle)) :]
    greatest = float(sliding_A.max())
    if float(np.ptp(end)) > STEADY * greatest or float(end.mean()) > RUN_UP * greatest:
        return None
    return float(end.mean())


def _end_of_run_up(sliding_A: Array, running_A: float, per_cycle: float) -> int | None:
    """Return the sample from which on the current stays near that of the running motor.

    A stretch of one cycle stands for its middle.
    """
    high_A = float(sliding_A.max())
    above = np.flatnonzero(sliding_A > high_A - FALLEN * (high_A - running_A))
    end = int(above[-1]) + 1
    return None if end >= sliding_A.size else end + round(per_cycle / 2.0)


def _lowest(volts: Array, per_cycle: float) -> float | None:
    cycle = round(per_cycle)
    if volts.size < cycle:
        return None
    return float(np.sqrt(_sliding_means(volts, cycle).min()))


def _curve(squares: Array, volts: Array | None, rate_hz: float, per_cycle: float) -> StartCurve:
    samples = round(per_cycle) * max(1, ceil(squares.size / per_cycle / MOST_POINTS))
    return StartCurve(
        first_s=samples / 2.0 / rate_hz,
        step_s=samples / rate_hz,
        current_A=_means(squares, samples),
        voltage_V=None if volts is None else _means(volts, samples),
    )


def _means(squares: Array, samples: int) -> tuple[float, ...]:
    whole = squares[: squares.size // samples * samples].reshape(-1, samples)
    return tuple(float(f"{sqrt(one):.5g}") for one in whole.mean(axis=1).tolist())
