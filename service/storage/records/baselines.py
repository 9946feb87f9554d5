"""A motor's baseline, as a person chose it."""

from dataclasses import dataclass

from service.storage.records.recordings import RecordingEntry


@dataclass(frozen=True, slots=True)
class BaselineDoubt:
    """What speaks against a recording as one of a healthy motor."""

    recording_id: str
    doubt: str


@dataclass(frozen=True, slots=True)
class BaselineEntry:
    """The recordings, oldest first, with those in doubt; when they were chosen, why, and who said so.

    account: that chose them. by: whom somebody named, else the account.
    A motor without a baseline has one without recordings.
    """

    recordings: tuple[RecordingEntry, ...] = ()
    chosen_ns: int | None = None
    reason: str | None = None
    account: str | None = None
    by: str | None = None
    doubts: tuple[BaselineDoubt, ...] = ()

    @property
    def on_behalf_of(self) -> str | None:
        """Return whom somebody named as who chose them; None for nobody but the account."""
        return None if self.by == self.account else self.by
