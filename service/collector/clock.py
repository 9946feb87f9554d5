"""How far a relay's clock is from ours, told by the stamp it gives to something we made it do.

A relay stamps the change of a control's status with its own clock (IEC 61850-7-3, `t`). The change happened
between our asking and its answer, so the stamp is off by the clock's offset, give or take half that time.
"""

import time

from mms import (
    AccessDenied,
    Client,
    FunctionalConstraint,
    NotFound,
    TemporarilyUnavailable,
    Timestamp,
    ValueRefused,
)
from service.storage.records import ClockReading
from service.storage.states import ClockQuality

FRACTION_BITS = 0x1F
"""Of the quality octet: significant bits of the fraction of a second; more than 24 means unspecified."""

MOST_BITS = 24
SECOND_NS = 1_000_000_000


def stamp_of(client: Client, control: str) -> Timestamp | None:
    """The stamp of a control's latest change; None where the relay gives none. Raises MmsError (the link)."""
    try:
        stamp = client.read(f"{control}.t", FunctionalConstraint.ST)
    except (AccessDenied, NotFound, TemporarilyUnavailable, ValueRefused):
        return None
    return stamp if isinstance(stamp, Timestamp) and stamp.ns > 0 else None


def reading(stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> ClockReading:
    """The relay's clock less ours, from the stamp of what happened between two times [ns UTC, our clock]."""
    bits = stamp.quality & FRACTION_BITS
    resolution_ns = SECOND_NS >> bits if bits <= MOST_BITS else 0
    if stamp.clock_failure:
        quality = ClockQuality.FAILED
    elif stamp.clock_not_synchronised:
        quality = ClockQuality.NOT_SYNCHRONISED
    else:
        quality = ClockQuality.SYNCHRONISED
    return ClockReading(
        offset_ns=stamp.ns - (asked_ns + answered_ns) // 2,
        uncertainty_ns=(answered_ns - asked_ns) // 2 + resolution_ns,
        quality=quality,
        measured_ns=time.time_ns(),
    )
