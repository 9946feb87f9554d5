"""What is kept of a back-up."""

from dataclasses import dataclass

from service.storage.states import BackupState


@dataclass(frozen=True, slots=True)
class BackupEntry:
    """A back-up: whether it is under way, verified or failed, where it lies, and what it consists of."""

    id: str
    state: BackupState
    directory: str
    name: str | None
    due_ns: int | None
    began_ns: int
    ended_ns: int | None
    recordings: int | None
    files: int | None
    size_bytes: int | None
    problem: str | None
