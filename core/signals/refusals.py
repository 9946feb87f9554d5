"""Why channels of a recording were not taken for the terminals of the motor: what a refusal lists."""

from collections.abc import Iterable

from core.recordings.channel_roles import is_computed
from core.recordings.errors import quoted
from core.recordings.waveform import Channel, Quantity, Recording

MOST_LISTED = 40
"""Channels that a refusal names; recorders of a substation have hundreds."""
UNITS = {Quantity.CURRENT: "A", Quantity.PHASE_VOLTAGE: "V", Quantity.LINE_VOLTAGE: "V"}


def reasons(recording: Recording, quantity: Quantity) -> str:
    """List all channels, each with why it is none that was looked for.

    Parameters
    ----------
    recording : Recording
        The recording.
    quantity : Quantity
        What was looked for.

    Returns
    -------
    str
        The list, for a refusal.
    """
    said = [f"{_named(channel)}: {_why_not(channel, quantity)}" for channel in recording.channels]
    return _cut(said, "; ") or "no channels"


def listing(channels: Iterable[Channel]) -> str:
    """List channels with their units.

    Parameters
    ----------
    channels : iterable of Channel
        The channels.

    Returns
    -------
    str
        The list, for a refusal.
    """
    return _cut([_named(channel) + ", constant" * channel.is_constant for channel in channels], ", ")


def _named(channel: Channel) -> str:
    return f"{quoted(channel.name)} [{channel.unit}]"


def _cut(said: list[str], between: str) -> str:
    more = len(said) - MOST_LISTED
    return between.join(said[:MOST_LISTED]) + (f"{between}and {more} more" if more > 0 else "")


def _why_not(channel: Channel, quantity: Quantity) -> str:
    if channel.is_constant:
        return "constant"
    if channel.unit != UNITS[quantity]:
        return f"not in {UNITS[quantity]}"
    if is_computed(channel.name):
        return "computed, by its name"
    if channel.phase is None:
        return "no phase in its name and phase field, or two that contradict each other"
    if channel.phase == "n":
        return "of the neutral"
    return f"phase {channel.phase}"
