"""Check what the motor does in the record: whether it runs all the time, or starts or stops.

A start or a stop explains most of what other checks find of such a record: currents cut off, a voltage that
comes or goes, no one frequency. It is therefore looked for before them, in the current's size alone, and
where the ratios are wrong too, in its course alone.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.quality.circle_diagram import circle_diagram
from core.quality.currents import LEAST_OF_NO_LOAD
from core.quality.finding import QualityFinding, finding
from core.signals.terminals import Terminals

NO_CURRENT = 0.02
"""Share of the greatest current of a cycle below which there is none: large motors without load draw 4 % of
what they draw when they are switched on, the direct part of that included."""
STARTING = 0.5
"""Share of the locked rotor's current at rated voltage that only a start reaches: severe shorts at full load
draw 0.35."""
RUN_UP = 0.5
"""Share of its first current to which the current of a motor that runs up falls."""
FEWEST_CYCLES = 3
WHAT_TO_DO = (
    "`mcc commission` estimates the motor's parameters from such a record; a diagnosis needs one of steady "
    "running"
)


def is_small(terminals: Terminals, motor: Motor) -> bool:
    """Return whether the currents are less than any running motor's.

    Converters that show next to nothing stand still; what is to be told of them is that no current flows.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, with finite samples.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.

    Returns
    -------
    bool
        Whether they are.
    """
    no_load = circle_diagram(motor, motor.nameplate.rated_frequency_Hz).at_no_load
    least = LEAST_OF_NO_LOAD * no_load * motor.nameplate.rated_voltage_V / np.sqrt(3.0)
    return bool(terminals.current_abc.std(axis=1).max() < least)


def operation(terminals: Terminals, motor: Motor) -> Iterator[QualityFinding]:
    """Check that the motor neither starts nor stops within the record; only failures are told.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, with finite samples.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.

    Yields
    ------
    QualityFinding
        A failure.
    """
    frequency = motor.nameplate.rated_frequency_Hz
    course = _course(terminals.current_abc, terminals.sample_rate_hz / frequency)
    if course.size < FEWEST_CYCLES or course.max() == 0.0:
        return
    circle = circle_diagram(motor, frequency)
    greatest, first, last = float(course.max()), float(course[0]), float(course[-1])
    over_rated = f"{greatest / circle.rated_current_A:.2g} times the rated one"
    from_rest, to_rest = first < NO_CURRENT * greatest, last < NO_CURRENT * greatest
    locked = circle.at_standstill * motor.nameplate.rated_voltage_V / np.sqrt(3.0)
    runs_up = first > STARTING * locked and last < RUN_UP * first
    if from_rest and to_rest:
        name = "start"
        message = "the motor is switched on and off again within the record: record again while it runs"
    elif from_rest:
        name = "start"
        message = f"the motor starts, its current comes and reaches {over_rated}: {WHAT_TO_DO}"
    elif to_rest:
        name = "stop"
        message = "the motor is switched off within the record: record again while it runs"
    elif runs_up:
        name = "start"
        message = (
            f"the motor runs up, its current falls from {over_rated} to {last / first:.0%} of that: record "
            "while it runs for a diagnosis, or a start from before it on for `mcc commission`"
        )
    else:
        return
    yield finding(
        name, min(first, last) / greatest, RUN_UP if runs_up else NO_CURRENT, "of the greatest current",
        passed=False, message=message,
    )  # fmt: skip


def _course(current_abc: Array, per_cycle: float) -> Array:
    """Return the current over the record's cycles, rms of the three phases [A].

    The mean of each cycle is taken off: a current transformer's offset is no current, and the slowly falling
    direct part of a start would hide how the current begins.
    """
    edges = np.floor(np.arange(int(current_abc.shape[1] / per_cycle) + 1) * per_cycle).astype(np.int64)
    cycles = [current_abc[:, a:b] for a, b in pairwise(edges)]
    return np.array([float(np.sqrt(np.mean(np.var(cycle, axis=1)))) for cycle in cycles])
