"""What a recording is told of its relay's clock: the latest reading, unless it is of another time.

Clocks drift and are set: a reading says little of what a relay stamped long before or after.
"""

from core.units import NANOSECONDS_PER_SECOND
from service.storage.models import IedRow, RecordingRow

NEAR_NS = 3600 * NANOSECONDS_PER_SECOND
"""A recording is given a reading at most this far from it."""

ZONE_NS = 14 * 3600 * NANOSECONDS_PER_SECOND
"""UTC+14 is the farthest local time; records do not always tell that theirs is local."""


def give_clock(recording: RecordingRow, relay: IedRow) -> None:
    """Give a recording its relay's latest clock reading.

    A reading more than NEAR_NS from the time when the record was first seen is not given.
    """
    if relay.clock_measured_ns is None or abs(relay.clock_measured_ns - recording.announced_ns) > NEAR_NS:
        return
    recording.clock_offset_ns = relay.clock_offset_ns
    recording.clock_uncertainty_ns = relay.clock_uncertainty_ns
    recording.clock_quality = relay.clock_quality
    recording.clock_measured_ns = relay.clock_measured_ns


def withdraw_clock(recording: RecordingRow) -> None:
    """Withdraw a recording's clock reading if the record's own time contradicts it.

    The record's time is known now: the record was seen long after it was made, or the clock was set since.
    """
    if recording.recorded_ns is None or recording.clock_measured_ns is None:
        return
    made_ns = recording.recorded_ns - (recording.clock_offset_ns or 0)
    if abs(made_ns - recording.clock_measured_ns) > NEAR_NS + ZONE_NS:
        recording.clock_offset_ns = recording.clock_uncertainty_ns = None
        recording.clock_quality = recording.clock_measured_ns = None
