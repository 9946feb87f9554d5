"""Check what the motor does in the record: whether it runs all the time, stands, starts or stops.

A start or a stop explains most of what other checks find of such a record: currents cut off, a voltage that
comes or goes, samples that repeat at rest, no one frequency. It is therefore looked for before them, in the
course of the current. The voltages may come from either side of the contactor: they only tell samples that
are lost from a motor that is switched off.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Motor
from core.operation import Operation
from core.quality.circle_diagram import CircleDiagram, circle_diagram
from core.quality.currents import CLEAN, COMPUTED_SUM, LEAST_OF_NO_LOAD
from core.quality.finding import QualityFinding, finding
from core.quality.magnitude import LEAST_SIGNAL, is_far_too_large
from core.quality.samples import FEWEST_SAMPLES_A_CYCLE
from core.quantity_text import plain
from core.signals.clarke import CLARKE
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import sequence_phasors
from core.signals.terminals import Terminals

NO_CURRENT = 0.02
"""Share of the greatest current of a cycle below which there is none: large motors without load draw 4 % of
what they draw when they are switched on, the direct part of that included."""
MOST_NOISE = 0.2
"""Share of the greatest current up to which what is no fundamental may be noise of a motor at rest."""
FROZEN = 0.02
"""Share of the greatest current above which a value that does not change is no current at rest."""
A_CURRENT = 0.5
"""Least share of the fundamental in the greatest cycle of a current; noise and single pulses have less."""
STARTING = 0.5
"""Share of the locked rotor's current at rated voltage that only a start reaches: severe shorts at full load
draw 0.35."""
RUN_UP = 0.5
"""Share of its first current to which the current of a motor that runs up falls."""
DIRECT = 0.6
"""Least share of its greatest current that a motor draws in its second cycle when it is switched on directly:
a soft starter and a drive begin with less, a star connection with a third."""
INRUSH = 1.5
"""Least inrush, over the rated current."""
BALANCED = 3.0
"""Least ratio of a sequence to what is beside it from which small currents are a motor's, scaled wrongly."""
THREE_WIRES = 0.05
"""Most that the currents of three wires leave in their sum, over the greatest; hum leaves more."""
MUCH = 0.15
"""Share of the greatest current above which a cycle has much of it."""
FEWEST_CYCLES = 3
LARGEST_OFFSET_A = 1e12
"""Currents beyond are none, however little they change, and leave no digits to compute with."""
RECORD_AGAIN = "record again while it runs"
WHAT_TO_DO = (
    "`mcc commission` estimates the motor's parameters from such a record; a diagnosis needs one of steady "
    "running"
)
NOT_DIRECT = (
    "`mcc commission` takes only direct starts, whose voltage is the supply's from the first instant; "
    "record again while the motor runs for a diagnosis"
)


@dataclass(frozen=True, slots=True)
class Course:
    """The currents over the cycles of a record.

    Parameters
    ----------
    rms_A : ndarray, shape (cycles,)
        Current of each cycle, rms of the three phases without their means [A].
    fundamental_A : ndarray, shape (cycles,)
        What of it has the rated frequency [A].
    is_rest : ndarray of bool, shape (cycles,)
        Whether no current flows.
    edges : ndarray of int, shape (cycles + 1,)
        Samples at which the cycles begin, and the last ends.
    """

    rms_A: Array
    fundamental_A: Array
    is_rest: NDArray[np.bool_]
    edges: NDArray[np.int64]

    @property
    def greatest_A(self) -> float:
        """Current of the greatest cycle, rms [A]."""
        return float(self.rms_A.max())

    @property
    def is_clean(self) -> bool:
        """Whether the greatest cycle is a current, neither noise nor a pulse."""
        greatest = int(self.rms_A.argmax())
        return bool(self.fundamental_A[greatest] > A_CURRENT * self.rms_A[greatest])

    @property
    def interruption(self) -> int | None:
        """The first cycle without current between others with much of it; None without one."""
        much = self._much
        within = np.flatnonzero(self.is_rest[: much[-1]])
        within = within[within > much[0]]
        return int(within[0]) if within.size else None

    @property
    def is_direct(self) -> bool:
        """Whether the current comes at once, as it does on a direct start, and not by steps or a ramp."""
        second = int(self._much[0]) + 1
        return second >= self.rms_A.size or bool(self.rms_A[second] > DIRECT * self.greatest_A)

    @property
    def _much(self) -> NDArray[np.int64]:
        """The cycles whose current is no noise, whatever there is of it."""
        return np.flatnonzero(self.rms_A > MUCH * self.greatest_A)


def course_of(current_abc: Array, per_cycle: float) -> Course | None:
    """Follow the current over the record's cycles.

    The mean of each cycle is taken off: a current transformer's offset is no current, and the slowly falling
    direct part of a start would hide how the current begins.

    Parameters
    ----------
    current_abc : ndarray, shape (3, n)
        Line currents of terminals a, b, c, finite [A].
    per_cycle : float
        Samples in one cycle of the rated frequency.

    Returns
    -------
    Course or None
        The course; None where the record is too short for one, or has no current at all.
    """
    edges = np.floor(np.arange(int(current_abc.shape[1] / per_cycle) + 1) * per_cycle).astype(np.int64)
    if edges.size <= FEWEST_CYCLES:
        return None
    x, first, length = current_abc[:, : edges[-1]], edges[:-1], np.diff(edges)
    mean = np.add.reduceat(x, first, axis=1) / length
    square = np.add.reduceat(x**2, first, axis=1) / length
    course = np.sqrt(np.maximum(square - mean**2, 0.0).mean(axis=0))
    if course.max() == 0.0:
        return None
    turn = np.exp(-2j * np.pi * np.arange(edges[-1]) / per_cycle)
    offset = mean * np.add.reduceat(turn, first)
    phasors = (np.add.reduceat(x * turn, first, axis=1) - offset) / length
    waves = np.sqrt(2.0 * np.mean(np.abs(phasors) ** 2, axis=0))
    swing = (np.maximum.reduceat(x, first, axis=1) - np.minimum.reduceat(x, first, axis=1)).max(axis=0)
    # A converter that froze shows one value, and not all three phases cross zero at once.
    frozen = (swing == 0.0) & (np.abs(mean).max(axis=0) > FROZEN * course.max())
    at_rest = (course < MOST_NOISE * course.max()) & (waves < NO_CURRENT * course.max()) & ~frozen
    return Course(course, waves, at_rest, edges)


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
    circle = circle_diagram(motor, motor.nameplate.rated_frequency_Hz)
    return _is_small(terminals, motor, circle)


def operation(terminals: Terminals, motor: Motor, *, tripped: bool = False) -> Iterator[QualityFinding]:
    """Check that the motor runs all through the record; only failures are told.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals, with finite samples.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    tripped : bool, default False
        Whether the relay's trip signal rises in the record.

    Yields
    ------
    QualityFinding
        A failure, with what the motor does.
    """
    per_cycle = terminals.sample_rate_hz / motor.nameplate.rated_frequency_Hz
    if per_cycle < FEWEST_SAMPLES_A_CYCLE or is_far_too_large(terminals, motor.nameplate):
        return
    if float(np.abs(terminals.current_abc).max()) > LARGEST_OFFSET_A:
        return
    circle = circle_diagram(motor, motor.nameplate.rated_frequency_Hz)
    course = course_of(terminals.current_abc, per_cycle)
    if course is not None and course.is_clean and course.is_rest.any() | _runs_up(course, motor, circle):
        yield from _switching(course, terminals, motor, circle, tripped=tripped)
    elif _is_small(terminals, motor, circle) and not _is_scaled_down(terminals, motor):
        yield _standing(terminals, motor, circle)


def _standing(terminals: Terminals, motor: Motor, circle: CircleDiagram) -> QualityFinding:
    share = float(terminals.current_abc.std(axis=1).max()) / circle.rated_current_A
    dead = terminals.voltage_ab is not None and _voltage_share(terminals, motor) <= LEAST_SIGNAL
    seen = "there is neither voltage nor current" if dead else "there is no current"
    return finding(
        "not-running", share, LEAST_OF_NO_LOAD * _no_load_A(motor, circle) / circle.rated_current_A,
        "of rated", passed=False, operation=Operation.NOT_RUNNING,
        message=f"{seen}: the motor is switched off (or its current transformers are); {RECORD_AGAIN}, or "
        "have its schedule ask for running motors only (`schedule_only_running`)",
    )  # fmt: skip


def _switching(
    course: Course, terminals: Terminals, motor: Motor, circle: CircleDiagram, *, tripped: bool
) -> Iterator[QualityFinding]:
    """Yield what the course of a current shows that comes, goes or falls."""
    from_rest, to_rest = bool(course.is_rest[0]), bool(course.is_rest[-1])
    if _are_samples_lost(course, terminals):
        return
    first, last, greatest = float(course.rms_A[0]), float(course.rms_A[-1]), course.greatest_A
    least, limit = min(first, last) / greatest, NO_CURRENT
    if to_rest:
        kind, message = _ending(from_rest=from_rest, tripped=tripped)
    elif from_rest or course.interruption is not None:
        kind = Operation.START
        message = _beginning(course, greatest / circle.rated_current_A, motor, from_rest=from_rest)
    else:
        kind, least, limit = Operation.START, last / greatest, RUN_UP
        message = (
            f"the motor runs up, its current falls from "
            f"{plain(greatest / circle.rated_current_A, 2)} times the rated one to {last / first:.0%} "
            "of that: record while it runs for a diagnosis, or a start from before it on for `mcc commission`"
        )
    yield finding(
        str(kind), least, limit, "of the greatest current", passed=False, message=message, operation=kind
    )


def _ending(*, from_rest: bool, tripped: bool) -> tuple[Operation, str]:
    """Return what it is that ends with no current."""
    if tripped:
        return Operation.TRIP, f"the relay trips the motor within the record: {RECORD_AGAIN}"
    if from_rest:
        return Operation.STOP, f"the motor is switched on and off again within the record: {RECORD_AGAIN}"
    return Operation.STOP, f"the motor is switched off within the record: {RECORD_AGAIN}"


def _beginning(course: Course, over_rated: float, motor: Motor, *, from_rest: bool) -> str:
    """Return in words how the motor starts."""
    interruption = course.interruption
    if interruption is not None:
        at_s = interruption / motor.nameplate.rated_frequency_Hz
        return (
            f"the motor starts in steps: its current is interrupted {at_s:.2f} s after the record's "
            f"beginning and comes again, as from star to delta; {NOT_DIRECT}"
        )
    if from_rest and not course.is_direct:
        return (
            "the motor starts through a soft starter, a drive or a reduced voltage: its current rises slowly "
            f"and reaches {plain(over_rated, 2)} times the rated one; {NOT_DIRECT}"
        )
    if over_rated < INRUSH and course.greatest_A < INRUSH * float(course.rms_A[-1]):
        return (
            "the current begins within the record without an inrush, it reaches "
            f"{plain(over_rated, 2)} times the rated one: samples lost at the beginning, a start "
            "through a drive, or currents scaled wrongly. "
            f"`mcc commission` needs an inrush of {INRUSH:g} times or more; {RECORD_AGAIN}"
        )
    return (
        f"the motor starts, its current comes and reaches {plain(over_rated, 2)} times the rated one: "
        f"{WHAT_TO_DO}"
    )


def _runs_up(course: Course, motor: Motor, circle: CircleDiagram) -> bool:
    """Whether the record begins within a start: the current of a locked rotor, which falls."""
    locked = circle.at_standstill * motor.nameplate.rated_voltage_V / np.sqrt(3.0)
    first, last = float(course.rms_A[0]), float(course.rms_A[-1])
    return first > STARTING * locked and last < RUN_UP * first


def _are_samples_lost(course: Course, terminals: Terminals) -> bool:
    """Whether nothing at all is recorded where no current flows, and the rest runs steadily.

    What a recorder fills in for lost samples does not change at all, in any channel, and a motor does not
    begin to run without an inrush. The terminals of a motor that is switched off keep some voltage for a
    while, and a bus keeps all of it.
    """
    if terminals.voltage_ab is None:
        return False
    flowing = course.rms_A[~course.is_rest]
    if flowing.size == 0 or float(np.median(flowing)) * INRUSH < float(flowing.max()):
        return False
    rest = np.concatenate(
        [np.arange(course.edges[k], course.edges[k + 1]) for k in np.flatnonzero(course.is_rest)]
        or [np.zeros(0, dtype=np.int64)]
    )
    if rest.size == 0:
        return False
    both = np.vstack([terminals.current_abc[:, rest], terminals.voltages[:, rest]])
    return bool(np.all(np.ptp(both, axis=1) == 0.0))


def _is_small(terminals: Terminals, motor: Motor, circle: CircleDiagram) -> bool:
    return bool(terminals.current_abc.std(axis=1).max() < LEAST_OF_NO_LOAD * _no_load_A(motor, circle))


def _no_load_A(motor: Motor, circle: CircleDiagram) -> float:
    return circle.at_no_load * motor.nameplate.rated_voltage_V / float(np.sqrt(3.0))


def _is_scaled_down(terminals: Terminals, motor: Motor) -> bool:
    """Whether currents too small for a motor are nevertheless one's: clean, and those of three wires.

    The hum of its surroundings, which a motor at rest shows, is different in each channel.
    """
    rms = float(terminals.current_abc.std(axis=1).max())
    frequency = motor.nameplate.rated_frequency_Hz
    phasors = fundamental_phasors(terminals.current_abc, frequency, terminals.sample_rate_hz)
    greatest = float(np.abs(phasors).max())
    if rms == 0.0 or greatest < CLEAN * rms:
        return False
    left = float(abs(phasors.sum())) / greatest
    if COMPUTED_SUM < left < THREE_WIRES:
        return True
    both = sequence_phasors(CLARKE @ phasors)
    backward, forward = sorted((abs(both.positive), abs(both.negative)))
    return bool(forward > BALANCED * (backward + left * greatest))


def _voltage_share(terminals: Terminals, motor: Motor) -> float:
    return float(terminals.voltages.std(axis=1).max()) / motor.nameplate.rated_voltage_V
