"""Check for one steady operating point, because the models start in periodic steady state at one load."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.quality.circle_diagram import CircleDiagram
from core.quality.currents import Currents
from core.quality.finding import QualityFinding, finding
from core.quality.supply import Feed
from core.quality.swing import swing_period_s, without_swing
from core.signals.clarke import clarke
from core.signals.sequence import PhaseSequence, SequencePhasors
from core.signals.terminals import Terminals

UNSTEADY_CURRENT = 0.18
"""Farthest that the forward current goes from its mean, of rated: a load that swings by 10 % of the rated
torque moves it by 0.13 at most, a third of the rated load switched by as much as the limit."""
LARGEST_SWING = 0.9
"""The same with a regular swing in it: a compressor whose torque swings by half the rated one reaches 0.6."""
SWINGS = 3
"""Lines of a swing that are taken off: its own frequency and two multiples."""
PERIODS_NEEDED = 3.0
"""Periods of a swinging load that a record should hold."""
UNSTEADY_VOLTAGE = 0.1
"""The same limit of the voltage, as a share of its mean: dips, switching, and cycles lost from the record."""


def steadiness(
    terminals: Terminals, feed: Feed, currents: Currents, circle: CircleDiagram
) -> Iterator[QualityFinding]:
    """Check that supply and load are steady over the record.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    feed : Feed
        Frequency and phasors of the voltages.
    currents : Currents
        Phasors of the line currents.
    circle : CircleDiagram
        Currents that the healthy machine can draw.

    Yields
    ------
    QualityFinding
        A finding.
    """
    per_cycle = terminals.sample_rate_hz / feed.frequency_hz
    volts = _farthest(_course(feed.voltage_ab, feed.phasors, per_cycle))
    yield finding(
        "supply steadiness", volts, UNSTEADY_VOLTAGE, "of its mean", passed=volts <= UNSTEADY_VOLTAGE,
        message=f"the voltage moves by {volts:.0%} within the record: a dip, a switching, or cycles lost",
    )  # fmt: skip
    if volts > UNSTEADY_VOLTAGE:
        return
    course = _course(clarke(terminals.current_abc), currents.phasors, per_cycle)
    seen = np.abs(course) if feed.assumed else course
    of_rated = currents.strong / circle.rated_current_A
    amps, step_s = _farthest(seen) * of_rated, 1.0 / terminals.sample_rate_hz
    swing, left = amps, seen
    for _ in range(SWINGS):
        if UNSTEADY_CURRENT < amps <= LARGEST_SWING:
            left = without_swing(left, step_s, feed.frequency_hz)
            amps = _farthest(left) * of_rated
    steady = amps <= UNSTEADY_CURRENT
    moves = "" if steady else _what_moves(seen, step_s, feed.frequency_hz)  # that takes a long spectrum
    yield finding(
        "steadiness", amps, UNSTEADY_CURRENT, "of rated", passed=steady,
        message=f"the current moves by {swing:.0%} of the rated one within the record: {moves}",
    )  # fmt: skip
    if steady and swing > UNSTEADY_CURRENT:
        period_s = swing_period_s(seen, step_s, feed.frequency_hz)
        often = "" if period_s is None else f" every {period_s:.2g} s"
        yield QualityFinding(
            "pulsating load", swing, LARGEST_SWING, "of rated", passed=True,
            message=f"the load pulsates{often} and moves the current by {swing:.0%} of the rated one: what "
            "is steady beside it is diagnosed",
        )  # fmt: skip
    if feed.assumed or not steady:
        return
    against = np.conj(_course(clarke(terminals.current_abc), currents.phasors, -per_cycle))
    # What the means of a cycle leave of a fast swing of the load shows here too.
    limit = UNSTEADY_CURRENT * (1.0 + swing)
    uneven = float(np.abs(against - against.mean()).max() / np.sqrt(3.0)) / circle.rated_current_A
    yield finding(
        "phase steadiness", uneven, limit, "of rated", passed=uneven <= limit,
        message=f"the negative-sequence current moves by {uneven:.0%} of the rated one within the record: "
        "a fuse blows, a wire opens, or the motor starts or stops",
    )  # fmt: skip


def _what_moves(course: NDArray[np.complex128] | Array, step_s: float, frequency_hz: float) -> str:
    """Say what a load does that is not steady, and how long a record would tell the motor all the same."""
    period_s = swing_period_s(course, step_s, frequency_hz)
    if period_s is None:
        return "the load changes, or the motor starts or stops; record at a steady load"
    return (
        f"the load swings about every {period_s:.2g} s, or changes; record at a steady load, or at least "
        f"{PERIODS_NEEDED * period_s:.1f} s of it"
    )


def _course(x_ab: Array, phasors: SequencePhasors, per_cycle: float) -> NDArray[np.complex128]:
    """Return the stronger sequence over the record.

    A mean over each cycle keeps the one sequence and takes out the other, harmonics and offsets.
    """
    vector = x_ab[0] + 1j * x_ab[1]
    if phasors.sequence is PhaseSequence.ACB:
        vector = vector.conj()
    turning = vector * np.exp(-2j * np.pi / per_cycle * np.arange(vector.size))
    cycle = round(abs(per_cycle))
    sums = np.cumsum(np.concatenate([[0.0], turning]))
    return np.asarray((sums[cycle:] - sums[:-cycle]) / cycle, dtype=np.complex128)


def _farthest(course: NDArray[np.complex128] | Array) -> float:
    """Greatest distance from the mean, of the mean."""
    mean = course.mean()
    return float(np.abs(course - mean).max() / abs(mean))
