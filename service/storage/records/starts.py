"""Starts as the repository takes and hands them out."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from core.starts.changes import compare_starts
from core.starts.compared import StartChanges
from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart
from core.starts.filling import filled_by_report
from service.storage.records.conditions import ConditionEvent
from service.storage.states import StartSource


class ReportOutcome(StrEnum):
    """What became of a reported start: a row of its own, part of a recorded one, or known already."""

    ADDED = "added"
    JOINED = "joined"
    KNOWN = "known"


@dataclass(frozen=True, slots=True)
class ReportedStart:
    """A start as its relay's motor start report tells it."""

    time_ns: int
    examined: ExaminedStart


@dataclass(frozen=True, slots=True)
class ImportedStart:
    """A start of a report that was taken. id: of the start that it is, or is joined with."""

    id: str
    time_ns: int
    outcome: ReportOutcome


@dataclass(frozen=True, slots=True)
class StartEntry:
    """A start of a motor, and what it shows.

    recording_id: of a start that a report alone tells, an id of its own. examined: what the samples show, or
    the report where there are none. reported: what the relay's report tells of a start that was recorded.
    """

    recording_id: str
    motor: str
    time_ns: int
    examined: ExaminedStart
    source: StartSource = StartSource.RECORDING
    reported: ExaminedStart | None = None

    @property
    def start(self) -> MotorStart:
        """The figures by what `source` says."""
        return self.examined.figures

    @property
    def recording(self) -> str | None:
        """Id of the recording; None where there is none."""
        return self.recording_id if self.source is StartSource.RECORDING else None

    @property
    def filled(self) -> ExaminedStart:
        """The start with what its record does not show from the relay's report."""
        return self.examined if self.reported is None else filled_by_report(self.examined, self.reported)[0]

    @property
    def from_report(self) -> tuple[str, ...]:
        """Names of the figures of `filled` that a record does not show and the relay's report tells."""
        return () if self.reported is None else filled_by_report(self.examined, self.reported)[1]


@dataclass(frozen=True, slots=True)
class StartReference:
    """What the starts of a motor are compared with: recorded ones or, where there are none, reported ones.

    A relay measures its acceleration time by another rule, so that starts of both kinds are not compared.

    renewed: what made the reference begin anew; None where nothing did.
    """

    starts: Sequence[StartEntry]
    renewed: ConditionEvent | None

    def holds(self, entry: StartEntry) -> bool:
        """Return whether a start is one of the reference, or was before it."""
        renewed = self.renewed is not None and entry.time_ns < self.renewed.time_ns
        return renewed or any(entry.recording_id == one.recording_id for one in self.starts)

    def is_like(self, entry: StartEntry) -> bool:
        """Return whether a start is told by what tells of the reference; without one, any is."""
        return not self.starts or entry.source is self.starts[0].source

    def compared(self, entries: Sequence[StartEntry]) -> StartChanges | None:
        """Return how starts, taken together, differ from the reference; None for those that belong to it."""
        later = [entry for entry in entries if self.is_like(entry) and not self.holds(entry)]
        if not later:
            return None
        return compare_starts([one.examined for one in later], [one.examined for one in self.starts])
