"""Times of a recorder whose clock runs in local time, as UTC. Daylight saving time is taken into account."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

from core.recordings.waveform import Recording
from core.units import NANOSECONDS_PER_SECOND

_EPOCH = datetime(1970, 1, 1)


@dataclass(frozen=True, slots=True)
class UtcTime:
    """A local time as UTC.

    Parameters
    ----------
    ns : int
        UTC [ns since 1970].
    doubt : str or None
        Why the local time alone does not tell it, in words; None where it does.
    """

    ns: int
    doubt: str | None = None


def utc_of(local_ns: int, zone: ZoneInfo, near_ns: int | None = None) -> UtcTime:
    """Return the UTC of a local time.

    Of an hour that is there twice, when clocks are set back, the one nearer to a known time is taken. In an
    hour that is not there, when clocks are set forward, the recorder's clock had not been set yet.

    Parameters
    ----------
    local_ns : int
        Time of the local clock [ns since 1970 of that clock].
    zone : zoneinfo.ZoneInfo
        Time zone of the clock.
    near_ns : int or None, optional
        UTC that the time is near to, such as that of a trigger [ns]. Without it the earlier one is taken.

    Returns
    -------
    UtcTime
        The time.
    """
    local = _EPOCH + timedelta(seconds=local_ns // NANOSECONDS_PER_SECOND)
    first, second = (local_ns - _offset_ns(local.replace(tzinfo=zone, fold=fold)) for fold in (0, 1))
    if first == second:
        return UtcTime(first)
    if first > second:  # the earlier offset is the smaller one: clocks were set forward
        return UtcTime(
            first,
            f"{local} is not there in {zone.key}, where clocks were set forward: the recorder's was not yet",
        )
    if near_ns is None or abs(first - near_ns) <= abs(second - near_ns):
        return UtcTime(first, f"{local} is there twice in {zone.key}: the first is taken")
    return UtcTime(second, f"{local} is there twice in {zone.key}: the second is taken")


def in_utc(recording: Recording, zone: ZoneInfo, near_ns: int | None = None) -> Recording:
    """Return a recording whose times are UTC, from one whose recorder keeps local time.

    A recording whose file tells how far its times are ahead of UTC is in UTC already.

    Parameters
    ----------
    recording : Recording
        The recording, with times as the file has them.
    zone : zoneinfo.ZoneInfo
        Time zone of the recorder's clock.
    near_ns : int or None, optional
        UTC that its trigger is near to [ns].

    Returns
    -------
    Recording
        The recording. What was in doubt is among its warnings.

    Raises
    ------
    UnknownTimeError
        If the file tells no time.
    """
    if recording.has_time_code:
        return recording
    found = utc_of(recording.trigger_time_ns, zone, near_ns)
    doubts = () if found.doubt is None else (f"time: {found.doubt}",)
    return replace(
        recording,
        start_time_ns=recording.first_time_ns + found.ns - recording.trigger_time_ns,
        warnings=(*recording.warnings, *doubts),
    )


def _offset_ns(local: datetime) -> int:
    """Return how far a local clock is ahead of UTC [ns]."""
    offset = local.replace(tzinfo=UTC) - local.astimezone(UTC)
    return (offset.days * 86_400 + offset.seconds) * NANOSECONDS_PER_SECOND
