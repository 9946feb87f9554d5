"""Check for one steady operating point, because the models start in periodic steady state at one load."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.quality.circle_diagram import CircleDiagram
from core.quality.currents import Currents
from core.quality.finding import QualityFinding, finding
from core.quality.supply import Feed
from core.quality.swing import without_swing
from core.signals.clarke import clarke
from core.signals.sequence import PhaseSequence, SequencePhasors
from core.signals.terminals import Terminals

UNSTEADY_CURRENT = 0.18
"""Farthest that the forward current goes from its mean, of rated: a load that swings by 10 % of the rated
torque moves it by 0.13 at most, a third of the rated load switched by as much as the limit."""
LARGEST_SWING = 0.36
"""The same with a regular swing in it: broken bars beside a load that swings by 10 % of the rated torque
reach 0.25."""
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
    amps = _farthest(seen) * of_rated
    if UNSTEADY_CURRENT < amps <= LARGEST_SWING:
        amps = _farthest(without_swing(seen, 1.0 / terminals.sample_rate_hz, feed.frequency_hz)) * of_rated
    yield finding(
        "steadiness", amps, UNSTEADY_CURRENT, "of rated", passed=amps <= UNSTEADY_CURRENT,
        message=f"the current moves by {amps:.0%} of the rated one within the record: the load changes, or "
        "the motor starts or stops; record at a steady load",
    )  # fmt: skip


def _course(x_ab: Array, phasors: SequencePhasors, per_cycle: float) -> NDArray[np.complex128]:
    """Return the stronger sequence over the record.

    A mean over each cycle keeps the one sequence and takes out the other, harmonics and offsets.
    """
    vector = x_ab[0] + 1j * x_ab[1]
    if phasors.sequence is PhaseSequence.ACB:
        vector = vector.conj()
    turning = vector * np.exp(-2j * np.pi / per_cycle * np.arange(vector.size))
    cycle = round(per_cycle)
    sums = np.cumsum(np.concatenate([[0.0], turning]))
    return np.asarray((sums[cycle:] - sums[:-cycle]) / cycle, dtype=np.complex128)


def _farthest(course: NDArray[np.complex128] | Array) -> float:
    """Greatest distance from the mean, of the mean."""
    mean = course.mean()
    return float(np.abs(course - mean).max() / abs(mean))
