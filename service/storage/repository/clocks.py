"""What a recording is told of its relay's clock: the latest reading, unless it is of another time.

Clocks drift and are set: a reading says little of what a relay stamped long before or after.
"""

from core.units import NANOSECONDS_PER_SECOND
from service.storage.models import IedRow, RecordingRow

NEAR_NS = 3600 * NANOSECONDS_PER_SECOND
"""Between a reading and the recording it is given to."""

ZONE_NS = 14 * 3600 * NANOSECONDS_PER_SECOND
"""UTC+14 is the farthest local time; records do not always tell that theirs is local."""


def give_clock(recording: RecordingRow, relay: IedRow) -> None:
    """The relay's latest reading, if that was within NEAR_NS of when the record was first seen there."""
    if relay.clock_measured_ns is None or abs(relay.clock_measured_ns - recording.announced_ns) > NEAR_NS:
        return
    recording.clock_offset_ns = relay.clock_offset_ns
    recording.clock_uncertainty_ns = relay.clock_uncertainty_ns
    recording.clock_quality = relay.clock_quality
    recording.clock_measured_ns = relay.clock_measured_ns


def withdraw_clock(recording: RecordingRow) -> None:
    """The record's own time is known now: it was seen long after it was made, or the clock was set since."""
    if recording.recorded_ns is None or recording.clock_measured_ns is None:
        return
    made_ns = recording.recorded_ns - (recording.clock_offset_ns or 0)
    if abs(made_ns - recording.clock_measured_ns) > NEAR_NS + ZONE_NS:
        recording.clock_offset_ns = recording.clock_uncertainty_ns = None
        recording.clock_quality = recording.clock_measured_ns = None
