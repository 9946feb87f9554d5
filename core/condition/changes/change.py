"""A change as people are told of it: at the terminals, in its own measure."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot, sqrt
from typing import Any, Final

import numpy as np

from core.condition.assessment import Change, Level
from core.condition.changes.alarm import KINDS, Alarm, Weighing, by_kind
from core.condition.changes.hypotheses import Cause, Hypotheses
from core.condition.changes.size import size_of
from core.condition.changes.turns_level import TurnsLevel
from core.condition.kinds import Kind
from core.condition.observation import VoltageChannels
from core.diagnosis.channel_errors import channel_of
from core.diagnosis.turns_place import axis_of, phases_of
from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.machines.stator_winding import Winding
from core.machines.winding_frame import terminal_winding
from core.normal_distribution import NORMAL_95
from core.signals.sequence import PhaseSequence


def change_of(
    alarm: Alarm, weighing: Weighing, level: TurnsLevel, hypotheses: Hypotheses, filters: Any, bank: Any,
    motor: Motor, sequence: PhaseSequence, channels: VoltageChannels,
) -> Change:  # fmt: skip
    """Tell of a change.

    Parameters
    ----------
    alarm : Alarm
        The alarm.
    weighing : Weighing
        Weights after the latest record.
    level : TurnsLevel
        Change of the fault level, should it be shorted turns.
    hypotheses : array of Hypothesis
        All places of all causes.
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    channels : VoltageChannels
        Which voltages are measured.

    Returns
    -------
    Change
        The change at the terminals.
    """
    connection = motor.nameplate.connection
    cause = _likeliest(alarm, weighing)
    since_ns = level.onset_ns
    size: float | None = level.value
    interval: tuple[float, float] | None = level.interval
    channel: Winding | None = None
    if cause is not Cause.SHORTED_TURNS:
        at = _place(cause, weighing, hypotheses)
        since_ns = int(bank[int(weighing.best[at, 0])]["time_ns"])
        size = interval = None
        if at < len(hypotheses):
            size, interval = size_of(filters, bank, hypotheses, at, weighing.best[at])
            channel = _channel(cause, int(hypotheses[at]["place"]), connection, sequence, channels)
    return Change(
        since_ns=since_ns,
        detected_ns=alarm.detected_ns,
        probabilities=by_kind(weighing.probabilities),
        named=alarm.named,
        level=Level(
            level.value,
            level.deviation,
            terminal_winding(level.winding, sequence, connection),
            level.interval,
            phases_of(level.windings, motor, sequence),
            axis_of(level.axes_rad, level.axis_shares, motor, sequence),
        ),
        channel=channel,
        size=size,
        surely_above=alarm.surely_above,
        size_ci95=interval,
    )


CHANNELS: Final[Mapping[tuple[Kind, ...], Cause]] = {
    (Kind.VOLTAGE_CHANNEL,): Cause.VOLTAGE_CHANNEL,
    (Kind.CURRENT_CHANNEL,): Cause.CURRENT_CHANNEL,
}
"""Kinds whose size is followed while they are in the standing errors."""


def drifted(
    change: Change, moved: Array, spread: Array, hypotheses: Hypotheses, motor: Motor,
    sequence: PhaseSequence, channels: VoltageChannels,
) -> Change:  # fmt: skip
    """Return a change of a channel with what the standing errors have moved by since it was taken into them.

    Parameters
    ----------
    change : Change
        The change as it was then.
    moved : ndarray, shape (4,)
        By how much E and C have moved.
    spread : ndarray, shape (4,)
        Their variances.
    hypotheses : array of Hypothesis
        All places of all causes.
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    channels : VoltageChannels
        Which voltages are measured.

    Returns
    -------
    Change
        The change as it is now; the same where it is no channel's.
    """
    cause = CHANNELS.get(change.named)
    if cause is None or change.size is None or change.size_ci95 is None:
        return change
    connection = motor.nameplate.connection
    for it in hypotheses[hypotheses["cause"] == cause]:
        if _channel(cause, int(it["place"]), connection, sequence, channels) == change.channel:
            break
    else:
        return change
    first, u = 2 * int(it["column"]), complex(it["u"])
    more = (u.conjugate() * complex(moved[first], moved[first + 1])).real / abs(u) ** 2
    half = NORMAL_95 * sqrt(0.5 * float(spread[first] + spread[first + 1])) / abs(u)
    size = change.size + more
    below, above = (
        hypot(change.size - change.size_ci95[0], half),
        hypot(change.size_ci95[1] - change.size, half),
    )
    return replace(change, size=size, size_ci95=(size - below, size + above))


def continued(change: Change, earlier: Change | None) -> Change:
    """Return a change with what the same channel had changed by before its reference was learnt anew.

    Parameters
    ----------
    change : Change
        The change since that reference.
    earlier : Change or None
        The change that the reference was learnt with.

    Returns
    -------
    Change
        Both in one, where one channel or joint is named in both; else the change as it is.
    """
    if earlier is None or (earlier.named, earlier.channel) != (change.named, change.channel):
        return change
    if earlier.size is None or earlier.size_ci95 is None or change.size is None or change.size_ci95 is None:
        return change
    size = earlier.size + change.size
    below = hypot(earlier.size - earlier.size_ci95[0], change.size - change.size_ci95[0])
    above = hypot(earlier.size_ci95[1] - earlier.size, change.size_ci95[1] - change.size)
    return replace(change, since_ns=earlier.since_ns, size=size, size_ci95=(size - below, size + above))


def _likeliest(alarm: Alarm, weighing: Weighing) -> Cause:
    """Return the likeliest cause of those that have been named, or of all."""
    order = np.argsort(-weighing.probabilities, kind="stable")
    for index in order:
        cause = Cause(int(index))
        if not alarm.named or KINDS.get(cause, Kind.VOLTAGE_CHANNEL) in alarm.named:
            return cause
    return Cause(int(order[0]))


def _place(cause: Cause, weighing: Weighing, hypotheses: Hypotheses) -> int:
    """Return the likeliest place of a cause."""
    if cause >= Cause.IMPEDANCE:
        return len(hypotheses) + int(cause) - int(Cause.IMPEDANCE)
    return int(np.argmax(np.where(hypotheses["cause"] == cause, weighing.logs[: len(hypotheses)], -np.inf)))


def _channel(
    cause: Cause, place: int, connection: Connection, sequence: PhaseSequence, channels: VoltageChannels
) -> Winding | None:
    if cause is Cause.ELEMENT:
        return None
    if cause is Cause.VOLTAGE_CHANNEL:
        return channel_of(place, channels, sequence)
    if cause is Cause.CURRENT_CHANNEL or place >= 3:
        return terminal_winding(place % 3, sequence, Connection.STAR)
    return terminal_winding(place, sequence, connection)
