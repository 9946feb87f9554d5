"""What is known of a relay: its clock, its link, who visits it, its findings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from core.units import NANOSECONDS_PER_SECOND
from service.storage.states import ClockQuality, LinkState


@dataclass(frozen=True, slots=True)
class ClockReading:
    """A relay's clock less ours, and what the relay says of its clock."""

    offset_ns: int
    uncertainty_ns: int
    quality: ClockQuality
    measured_ns: int


@dataclass(frozen=True, slots=True)
class Quarantine:
    """A relay set aside from `since_ns` until `until_ns`, and not trusted yet afterwards.

    times: how often in a row; 0 where it is one of several that are suspected.
    """

    ied: str
    reason: str
    times: int
    since_ns: int
    until_ns: int

    @property
    def pause_s(self) -> float:
        """Return for how long the relay is set aside [s]."""
        return (self.until_ns - self.since_ns) / NANOSECONDS_PER_SECOND

    @property
    def link_reason(self) -> str:
        """Return what the relay's link says of it while it is set aside."""
        until = datetime.fromtimestamp(self.until_ns // NANOSECONDS_PER_SECOND, UTC)
        return f"set aside until {until:%Y-%m-%dT%H:%M:%SZ}: {self.reason}"

    def holds(self, now_ns: int) -> bool:
        """Tell whether the relay is to be left alone at `now_ns`, by a clock that may have been set since.

        It is left alone only within the pause's own length of its beginning, on either side: a clock that
        was a day ahead keeps no relay away for a day, and one of another host, a second behind, ends no
        pause early.
        """
        return abs(now_ns - self.since_ns) < self.until_ns - self.since_ns


@dataclass(frozen=True, slots=True)
class GatewayEntry:
    """A process that visits relays, and how many it holds leases of.

    problem: what did not work in it at its latest heartbeat; None while all did.
    """

    id: str
    host: str
    process_id: int
    started_ns: int
    relays: int
    problem: str | None


@dataclass(frozen=True, slots=True)
class LinkChange:
    """A link's new state, since when and why."""

    changed_ns: int
    state: LinkState
    reason: str | None


@dataclass(frozen=True, slots=True)
class LinkTraffic:
    """What went over a link since it was last told."""

    connections: int = 0
    received_bytes: int = 0
    reports: int = 0
    report_gaps: int = 0


@dataclass(frozen=True, slots=True)
class LinkNote:
    """What went over a relay's link since the last note, until `now_ns`.

    day_bytes: counted against the limit of the UTC day `day` (days since 1970), until now.
    state: what the link is from now on, and the reason; None where it stays up, and the relay answered.
    """

    ied: str
    now_ns: int
    traffic: LinkTraffic
    round_trip_s: float | None
    day: int
    day_bytes: int
    state: LinkState | None = None
    reason: str | None = None

    @property
    def is_answer(self) -> bool:
        """Tell whether the relay answered at `now_ns`."""
        return self.state in (None, LinkState.UP)


@dataclass(frozen=True, slots=True)
class ClockNote:
    """A reading of a relay's clock."""

    ied: str
    reading: ClockReading


@dataclass(frozen=True, slots=True)
class ReportPosition:
    """The EntryID of the last report of a block whose records are stored."""

    ied: str
    entry_id: bytes
    report_control: str | None


@dataclass(frozen=True, slots=True)
class LinkFigures:
    """What went over a relay's link in all, and how long its latest answer took [s].

    report_gaps: how often reports were lost.  day_bytes: counted against the limit of the UTC day `day`
    (days since 1970).
    """

    ied: str
    round_trip_s: float | None = None
    connections: int = 0
    received_bytes: int = 0
    reports: int = 0
    report_gaps: int = 0
    day: int = 0
    day_bytes: int = 0


@dataclass(frozen=True, slots=True)
class RelayFindings:
    """What was found at a relay when it was last visited, as JSON documents.

    acquisition: what is used of it.  differences: from its SCL.  ignored_files: those of its events directory
    that are not taken, with the reason; `ignored_in_all` may be more.
    """

    ied: str
    found_ns: int
    acquisition: Mapping[str, object]
    differences: Sequence[Mapping[str, object]] = ()
    ignored_files: Sequence[Mapping[str, object]] = ()
    ignored_in_all: int = 0
