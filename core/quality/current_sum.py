"""Checks on the sum of the currents: of its fundamental and its harmonics, and what either is a sign of.

Three wires carry a sum of nothing. A fourth one does not: a star point on the neutral, or a load between one
line and the neutral. Nor do the windings of a delta, around which currents circle.
"""

from collections.abc import Iterator
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, CurrentPosition, Motor
from core.quality.currents import COMPUTED_SUM, Currents, most_sum, sum_of
from core.quality.finding import QualityFinding, finding
from core.quality.supply import Feed
from core.signals.terminals import Terminals

SATURATED, SATURATED_UNPAIRED = 0.05, 0.15
"""Limit for the 2nd and 3rd harmonic of the sum of the currents, over a phase current.

The sum of three wires has no such harmonics, whatever supply and winding are like. Saturated transformers
cause 10 % and more.
"""
SATURATED_PHASE = 0.15
"""Limit for the same harmonics of one phase.

It is used where the sum is zero because the recorder computed the third current.
"""
ALIKE = 0.8
"""Least share of the third harmonics that is alike in all phases, where a neutral or a delta carries them."""
OF_ZERO_VOLTAGE = 0.5
"""How far I0 may be from what V0 drives through a star point on the neutral, over I0."""
OF_ONE_LOAD_DEG = 20.0
"""How far I0 may turn from a phase's voltage that a heater on this phase draws it from."""
NEUTRAL = "the star point is on the neutral (`neutral = true` in the motor file)"
INSIDE_DELTA = (
    'the current transformers are inside the delta (`ct_position = "inside-delta"` in the motor file)'
)

_SIGNS = ((-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -1.0))


def saturation(currents: Currents, feed: Feed, motor: Motor) -> Iterator[QualityFinding]:
    """Check that the current transformers do not saturate.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.
    motor : Motor
        The motor.

    Yields
    ------
    QualityFinding
        The finding.
    """
    harmonics = currents.by_order[:, 1:]
    if motor.neutral:  # which carries third harmonics
        share, limit = float((np.abs(harmonics[:, 0]) / currents.sizes).max()), SATURATED_PHASE
    elif float(np.abs(currents.by_order[:, 0].sum())) < COMPUTED_SUM * currents.greatest:
        share = float((np.linalg.norm(harmonics, axis=1) / currents.sizes).max())
        limit = SATURATED_PHASE
    else:
        share = float(np.linalg.norm(harmonics.sum(axis=0))) / currents.greatest
        limit = SATURATED_UNPAIRED if feed.assumed else SATURATED
    yield finding(
        "saturation", share, limit, "of one phase", passed=share <= limit,
        message=f"2nd and 3rd harmonics make {share:.0%}, which three wires cannot carry: "
        f"{_where_harmonics_go(harmonics, motor)}",
    )  # fmt: skip


def adding_up(currents: Currents, feed: Feed, motor: Motor) -> Iterator[QualityFinding]:
    """Check that the currents add up to nothing; a sum shows a channel reversed or of a wrong ratio.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.
    motor : Motor
        The motor.

    Yields
    ------
    QualityFinding
        A finding.
    """
    phasors = currents.by_order[:, 0]
    limit, share = most_sum(feed), sum_of(currents)
    turned = [float(abs((phasors * np.array(signs)).sum())) / currents.greatest for signs in _SIGNS]
    best = int(np.argmin(turned))
    wrong = share > limit
    reversed_one = wrong and turned[best] <= limit
    yield finding(
        "current polarity", share, limit, "of one phase", passed=not reversed_one,
        message=f"with {currents.names[best]} the other way round the currents add up to nothing: "
        "exchange its wires",
    )  # fmt: skip
    if reversed_one:
        return
    yield finding(
        "current sum", share, limit, "of one phase", passed=not wrong,
        message=f"the three currents leave {share:.1%} where they should add up to nothing: "
        f"{_where_the_sum_goes(currents, feed, motor)}",
    )  # fmt: skip


def _where_harmonics_go(harmonics: NDArray[np.complex128], motor: Motor) -> str:
    saturates = (
        "a current transformer (or its input) saturates; take one with a smaller burden or a higher ratio"
    )
    second, third = np.abs(harmonics).mean(axis=0)
    alike = abs(harmonics[:, 1].mean()) > ALIKE * third and second < third
    if not alike:
        return saturates
    fourth = NEUTRAL if motor.nameplate.connection is Connection.STAR else INSIDE_DELTA
    return f"third harmonics are alike in all phases: {fourth}, or all transformers saturate"


def _where_the_sum_goes(currents: Currents, feed: Feed, motor: Motor) -> str:
    usual = "one is scaled or timed wrongly, or the motor has an earth fault"
    if motor.nameplate.connection is Connection.DELTA:
        return f"{INSIDE_DELTA}, or {usual}"
    zero = complex(currents.by_order[:, 0].mean())
    if feed.channels.size == len(currents.sizes) and abs(zero) > 0.0:
        machine = motor.parameters
        impedance = complex(
            machine.stator_resistance_ohm, 2.0 * pi * feed.frequency_hz * machine.stator_leakage_H
        )
        if abs(zero - complex(feed.channels.mean()) / impedance) < OF_ZERO_VOLTAGE * abs(zero):
            return f"{NEUTRAL}, or {usual}"
        off = np.abs(np.degrees(np.angle(zero / feed.channels)))
        if off.min() < OF_ONE_LOAD_DEG:
            phase, amps = "abc"[int(off.argmin())], 3.0 * abs(zero)
            return (
                f"a load behind the relay between phase {phase} and the neutral, of {amps:.3g} A, {NEUTRAL}, "
                f"or {usual}"
            )
    return f"{usual}, or {NEUTRAL}"


def transformers(terminals: Terminals, motor: Motor) -> Iterator[QualityFinding]:
    """Tell what is not seen for where the current transformers sit, and for the one there may not be.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    motor : Motor
        The motor.

    Yields
    ------
    QualityFinding
        A warning.
    """
    phase, position = terminals.computed_current, motor.transformers.current_position
    if phase is not None:
        yield _not_seen(
            f"phase {phase} has no current transformer: its current is minus the sum of the other two. A "
            "current to earth (I0), a transformer of a wrong ratio and a reversed one are not seen"
        )
    if position is CurrentPosition.INSIDE_DELTA:
        yield _not_seen(
            "inside the delta: line currents are differences of the windings' currents. A current to earth "
            "(I0) and one that circles in the delta are not seen"
        )
    if position is CurrentPosition.BEFORE_CAPACITORS and motor.capacitors is None:
        yield _not_seen(
            "before the capacitors: current, power factor and load are those of motor and capacitors "
            "together. A capacitor that fails looks like an asymmetry of the motor"
        )


def _not_seen(message: str) -> QualityFinding:
    return QualityFinding("current transformers", 1.0, 1.0, "", passed=True, message=message)
