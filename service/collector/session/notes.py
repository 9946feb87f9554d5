"""What a session has to say of its relay all the time, and that nothing waits for."""

from typing import Protocol

from service.storage import Repository
from service.storage.records import ClockNote, LinkNote, RelayFindings, ReportPosition


class Notes(Protocol):
    """Takes what is to be written. It may write later, all in the order in which it came."""

    def add_note(self, note: LinkNote) -> None:
        """Write what went over a link, and the state it has from then on. Raises SQLAlchemyError."""

    def add_findings(self, findings: RelayFindings) -> None:
        """Write what was found at a relay. Raises SQLAlchemyError."""

    def add_clock(self, note: ClockNote) -> None:
        """Write how far a relay's clock is from ours. Raises SQLAlchemyError."""

    def add_position(self, position: ReportPosition) -> None:
        """Write where to resume a relay's reports. Raises SQLAlchemyError."""


class WrittenAtOnce:
    """Writes each note in a transaction of its own: for a session that shares no gateway with others."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository

    def add_note(self, note: LinkNote) -> None:
        self._repository.note_links((note,))

    def add_findings(self, findings: RelayFindings) -> None:
        self._repository.note_findings(findings)

    def add_clock(self, note: ClockNote) -> None:
        self._repository.note_clocks((note,))

    def add_position(self, position: ReportPosition) -> None:
        self._repository.save_report_positions((position,))
