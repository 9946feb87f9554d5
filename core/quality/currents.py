"""Checks that the currents are those of a running motor: all phases present, undistorted, in sequence."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.operation import Operation
from core.quality.circle_diagram import CircleDiagram
from core.quality.finding import QualityFinding, finding
from core.quality.ratios import appended, current_advice, current_cause, power_in_kW
from core.quality.supply import Feed
from core.quantity_text import with_unit
from core.recordings import Channel
from core.signals.clarke import CLARKE
from core.signals.phasors import harmonic_phasors
from core.signals.sequence import SequencePhasors, sequence_phasors
from core.signals.terminals import Terminals

OPEN_WIRE, OPEN_CHANNEL = 0.01, 0.1
"""Least ratio of the smallest phase current to the greatest.

An open wire carries no current. Severe shorts without load on an unbalanced supply reach 0.016, and their
currents add up to zero. With an open channel they do not, and the channel may show crosstalk.
"""
COMPUTED_SUM = 1e-6
CURRENT_SUM, CURRENT_SUM_UNPAIRED = 0.045, 0.3
"""Fundamental of the currents' sum over the greatest: 1 % and 50 us between channels leave 2.6 % at worst.
Unpaired: currents recorded without voltages often come from sensors scaled one by one."""
LEAST_OF_NO_LOAD = 0.5
"""Least positive-sequence current over the no-load current.

Errors of the sensors and of parameters within 10 % lower it to 0.85 at most.
"""
LESS_IN_STAR, STAR_RANGE = 3.0, (0.8, 1.3)
"""How much less a motor for delta draws in star, and the range of its currents in delta."""
MOST_OF_STANDSTILL, IMPOSSIBLE_OF_STANDSTILL = 0.6, 1.4
"""Shares of the locked rotor's current: severe shorts at full load reach 0.35; only a wrong ratio exceeds
1."""
CLEAN = 0.8
"""Least share of the fundamental in the rms value.

It separates a small clean current, which is scaled wrongly, from noise without a current.
"""
BACKWARD = 1.3
"""Backward over forward current, in the supply's own sense: exchanged phases make 2 and more; a motor without
load on a supply unbalanced by 5 %, with severe shorts, comes near 1."""
STRONGLY_UNBALANCED = 0.05
"""Unbalance of a supply beyond which a motor that runs light looks as if two of its phases were exchanged."""
LEAST_LAG_DEG, MOST_LAG_DEG = -20.0, 110.0
"""Range of the lag of the current: 0 to 90 degrees of a motor, widened by delays between channels."""

NEAR_GENERATING_DEG, MAYBE_DEG = 15.0, 45.0
"""How far a lag may be from that of a generating machine: with parameters within 10 %; with severe shorts."""
NEAR_RING_DEG = 30.0
"""How far a lag may be from a third of a cycle off, where phases may be exchanged in a ring."""
LEAST_LAG_AT_REST_DEG = 45.0
"""Least lag of a locked rotor's current: its power factor is 0.1 to 0.6, that of full load 0.7 and more."""


@dataclass(frozen=True, slots=True)
class Currents:
    """Phasors of the line currents, rms [A].

    Parameters
    ----------
    by_order : ndarray of complex, shape (3, 3)
        Of each phase the fundamental, the 2nd and the 3rd harmonic.
    phasors : SequencePhasors
        Symmetrical components of the fundamental.
    channels : tuple of Channel
        The channels.
    rms : float
        Greatest phase with everything in it, without its mean.
    """

    by_order: NDArray[np.complex128]
    phasors: SequencePhasors
    channels: tuple[Channel, ...]
    rms: float

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the channels."""
        return tuple(channel.name for channel in self.channels)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """Fundamental of each phase, rms [A]."""
        return np.abs(self.by_order[:, 0])

    @property
    def greatest(self) -> float:
        """Greatest fundamental of the phases, rms [A]."""
        return float(self.sizes.max())

    @property
    def strong(self) -> float:
        """The greater of the two sequences, rms [A]."""
        return max(abs(self.phasors.positive), abs(self.phasors.negative))


def currents_of(terminals: Terminals, frequency_hz: float) -> Currents:
    """Find the phasors of the line currents.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    frequency_hz : float
        Supply frequency [Hz].

    Returns
    -------
    Currents
        The phasors.
    """
    by_order = harmonic_phasors(terminals.current_abc, frequency_hz, terminals.sample_rate_hz, (1, 2, 3))
    return Currents(
        by_order=by_order,
        phasors=sequence_phasors(CLARKE @ by_order[:, 0]),
        channels=terminals.current_channels,
        rms=float(terminals.current_abc.std(axis=1).max()),
    )


def running(currents: Currents, feed: Feed, circle: CircleDiagram) -> Iterator[QualityFinding]:
    """Check that there is current of the supply's frequency, and less than a locked rotor's.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.
    circle : CircleDiagram
        Currents that the healthy machine can draw.

    Yields
    ------
    QualityFinding
        The finding.
    """
    share = currents.strong / (circle.at_standstill * feed.strong)
    off = _is_small(currents, feed, circle) and currents.greatest < CLEAN * currents.rms
    stalled = MOST_OF_STANDSTILL < share <= IMPOSSIBLE_OF_STANDSTILL
    why = (
        "there is no current at the supply's frequency: the motor is switched off"
        if off
        else f"a start, or a stalled motor: {share:.2f} of the locked rotor's current (or the currents are "
        "scaled 2 to 5 times too large); record while it runs for a diagnosis, or a start from before it on "
        "for `mcc commission`"
    )
    cause = current_cause(currents.strong, circle.running_range_A(feed.strong), currents.channels)
    if stalled and cause:
        asked = power_in_kW(currents.strong, circle.running_range_A(feed.strong), circle.rated_current_A)
        why += f"; {asked}{cause}"
    does = Operation.NOT_RUNNING if off else Operation.START if _lags_as_at_rest(currents, feed) else None
    yield finding(
        "not-running" if off else "running", share, MOST_OF_STANDSTILL, "of locked rotor",
        passed=not off and not stalled, message=why, operation=does,
    )  # fmt: skip


def level(currents: Currents, feed: Feed, circle: CircleDiagram) -> Iterator[QualityFinding]:
    """Check that the currents are scaled as the nameplate says.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.
    circle : CircleDiagram
        Currents that the healthy machine can draw.

    Yields
    ------
    QualityFinding
        The finding.
    """
    no_load, standstill = circle.at_no_load * feed.strong, circle.at_standstill * feed.strong
    small = _is_small(currents, feed, circle)
    drawn = f"no load {with_unit(no_load, 'A')}, locked rotor {with_unit(standstill, 'A')}"
    limit = LEAST_OF_NO_LOAD * no_load if small else IMPOSSIBLE_OF_STANDSTILL * standstill
    running_A = circle.running_range_A(feed.strong)
    advice = current_advice(currents.strong, running_A, circle.rated_current_A, currents.channels)
    yield finding(
        "current", currents.strong, limit, "A", passed=not small and currents.strong <= limit,
        message=f"{with_unit(currents.strong, 'A')} is {'less' if small else 'more'} than this motor can "
        f"draw ({drawn}): {_less_current(currents, feed, circle) if small else ''}a wrong ratio, secondary "
        f"amperes, kA for A, or another motor's nameplate{appended(advice)}",
    )  # fmt: skip


def _less_current(currents: Currents, feed: Feed, circle: CircleDiagram) -> str:
    """Say what besides wrong figures makes a current too small: windings in star, or capacitors."""
    if feed.assumed:
        return ""
    found, in_star = "", LESS_IN_STAR * currents.strong
    least, most = circle.running_range_A(feed.strong)
    if circle.is_delta and STAR_RANGE[0] * least <= in_star <= STAR_RANGE[1] * most:
        found = "it runs in star (a star-delta starter that stays in star), "
    voltage, forward, _ = _in_the_sense_of(feed, currents)
    seen = forward / voltage
    # What capacitors leave has the power of a motor: the real part of a point of the diagram.
    if 0.0 < seen.real < most / feed.strong:
        found += "capacitors that are measured with it ([capacitors] of the motor file), "
    return found


def _lags_as_at_rest(currents: Currents, feed: Feed) -> bool:
    """Whether the current lags as a locked rotor's; that of a loaded motor, scaled too large, lags less."""
    if feed.assumed:
        return False
    voltage, forward, _ = _in_the_sense_of(feed, currents)
    lag = float(np.degrees(np.angle(voltage * forward.conjugate())))
    return LEAST_LAG_AT_REST_DEG <= lag <= MOST_LAG_DEG


def _is_small(currents: Currents, feed: Feed, circle: CircleDiagram) -> bool:
    return currents.strong < LEAST_OF_NO_LOAD * circle.at_no_load * feed.strong


def phase_loss(currents: Currents, feed: Feed) -> Iterator[QualityFinding]:
    """Check that every phase carries current.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.

    Yields
    ------
    QualityFinding
        The finding.
    """
    least = float(currents.sizes.min() / currents.greatest)
    name = currents.names[int(currents.sizes.argmin())]
    limit = OPEN_CHANNEL if sum_of(currents) > most_sum(feed) else OPEN_WIRE
    yield finding(
        "phase loss", least, limit, "of the greatest", passed=least >= limit,
        message=f"{name} shows {least:.1%} of the greatest current: wire or channel open, or a fuse blown",
    )  # fmt: skip


def sum_of(currents: Currents) -> float:
    """Return the sum of the currents over the greatest."""
    return float(abs(currents.by_order[:, 0].sum())) / currents.greatest


def most_sum(feed: Feed) -> float:
    """Return the greatest sum that channels of three wires show."""
    return CURRENT_SUM_UNPAIRED if feed.assumed else CURRENT_SUM


def rotation(currents: Currents, feed: Feed) -> QualityFinding:
    """Check that the currents turn as the voltages do.

    The check holds however late the currents are and however fast the motor runs.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.

    Returns
    -------
    QualityFinding
        The finding.
    """
    _, forward, backward = _in_the_sense_of(feed, currents)
    share = abs(backward) / max(abs(forward), 1e-12)
    return finding(
        "phase order", share, BACKWARD, "backward over forward", passed=share <= BACKWARD,
        message=f"the currents turn against the voltages: two phases are exchanged{_doubt(feed)}",
    )  # fmt: skip


def order(currents: Currents, feed: Feed, circle: CircleDiagram) -> Iterator[QualityFinding]:
    """Check that the currents belong to the voltages.

    They have the same order of phases, and lag behind them as a motor's do.

    Parameters
    ----------
    currents : Currents
        Phasors of the line currents.
    feed : Feed
        Frequency and phasors of the voltages.
    circle : CircleDiagram
        Currents that the healthy machine can draw.

    Yields
    ------
    QualityFinding
        A finding.
    """
    if feed.assumed:
        return
    turning = rotation(currents, feed)
    if not turning.passed:
        yield turning
        return
    voltage, forward, _ = _in_the_sense_of(feed, currents)
    lag = float(np.degrees(np.angle(voltage * forward.conjugate())))
    within = LEAST_LAG_DEG <= lag <= MOST_LAG_DEG
    off = lag - circle.lag_deg(abs(forward) / abs(voltage))
    # A lag off by a third of a cycle means cyclically exchanged phases, one by half a cycle reversed ones.
    ring = not within and abs((off + 180.0) % 360.0 - 180.0) < 150.0
    nearest = LEAST_LAG_DEG if lag < LEAST_LAG_DEG else MOST_LAG_DEG
    off_generating = abs(lag - circle.generating_lag_deg(abs(forward) / abs(voltage)))
    off_ring = abs(abs((off + 180.0) % 360.0 - 180.0) - 120.0)
    if not within and off_generating < NEAR_GENERATING_DEG and off_ring > NEAR_RING_DEG:
        yield finding(
            "generating", lag, nearest, "degrees behind", passed=False,
            message=f"the currents lie {lag:.0f} degrees behind the voltages: the load drives the motor, "
            "which generates; record while it drives its load",
        )  # fmt: skip
        return
    if ring:
        generates = ", or the load drives the motor, which generates" if off_generating < MAYBE_DEG else ""
        yield finding(
            "phase order", lag, nearest, "degrees behind", passed=False,
            message=f"the currents lie {lag:.0f} degrees behind the voltages, a third of a cycle off: the "
            f"phases are exchanged in a ring{generates}",
        )  # fmt: skip
        return
    yield turning
    yield finding(
        "polarity", lag, nearest, "degrees behind", passed=within,
        message=f"the currents lie {lag:.0f} degrees behind the voltages, half a cycle off: all currents (or "
        "voltages) are reversed, or the machine generates",
    )  # fmt: skip


def _in_the_sense_of(feed: Feed, currents: Currents) -> tuple[complex, complex, complex]:
    """Voltage, and the currents that turn with and against it: rms phasors."""
    voltage, current = feed.phasors, currents.phasors
    if abs(voltage.positive) >= abs(voltage.negative):
        return voltage.positive, current.positive, current.negative
    return voltage.negative, current.negative, current.positive


def _doubt(feed: Feed) -> str:
    unbalance = feed.phasors.unbalance_factor
    unbalance = min(unbalance, 1.0 / max(unbalance, 1e-12))
    if unbalance < STRONGLY_UNBALANCED:
        return ""
    return f", or the motor runs light on a supply unbalanced by {unbalance:.0%}: record again under load"
