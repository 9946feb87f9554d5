"""From a relay's directory listing to recordings: which files belong together, and under which names.

A relay's file names are hostile until checked here: nothing later makes a local path of them or prints them
raw.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

REQUIRED_SUFFIXES = (".CFG", ".DAT")
OPTIONAL_SUFFIXES = (".HDR", ".INF")
LONGEST_NAME = 100


class FileEntry(Protocol):
    """What the MMS layer tells of a remote file."""

    @property
    def name(self) -> str: ...
    @property
    def size(self) -> int: ...
    @property
    def modified_ns(self) -> int: ...


@dataclass(frozen=True, slots=True)
class ListedFile:
    """One file of a record: the name to ask the relay for, and the checked name to keep it under."""

    remote_name: str
    local_name: str
    size: int
    modified_ns: int


@dataclass(frozen=True, slots=True)
class ListedRecord:
    """The files of one COMTRADE record, as listed. `name` is their common stem."""

    name: str
    files: tuple[ListedFile, ...]

    @property
    def size_bytes(self) -> int:
        return sum(file.size for file in self.files)

    @property
    def modified_ns(self) -> int:
        """Time of the youngest file, by the relay's clock [ns]."""
        return max(file.modified_ns for file in self.files)

    @property
    def missing(self) -> tuple[str, ...]:
        """Suffixes a COMTRADE record cannot do without and this one does not have."""
        present = {_suffix(file.local_name) for file in self.files}
        return tuple(suffix for suffix in REQUIRED_SUFFIXES if suffix not in present)


@dataclass(frozen=True, slots=True)
class RefusedFile:
    """A listed file that is not touched. `name` is safe to print."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True)
class Listing:
    """A directory of a relay, understood."""

    records: tuple[ListedRecord, ...]
    refused: tuple[RefusedFile, ...]


def understand(entries: Iterable[FileEntry], directory: str) -> Listing:
    """Group the listed files of `directory` into records.

    Other files (reports, Compressed ASCII of the same events) are passed over in silence. Files whose name
    cannot be trusted, or that claim another's name, are refused.
    """
    groups: dict[str, dict[str, ListedFile]] = {}
    refused: list[RefusedFile] = []
    for entry in entries:
        local_name = last_component(entry.name)
        suffix = _suffix(local_name)
        if suffix not in REQUIRED_SUFFIXES + OPTIONAL_SUFFIXES:
            continue
        reason = objection(entry.name, directory)
        files = groups.setdefault(local_name[: -len(suffix)].upper(), {}) if reason is None else {}
        if reason is None and suffix in files:
            reason = "the relay lists two files of this name"
        if reason is not None:
            refused.append(RefusedFile(name=ascii(entry.name)[:LONGEST_NAME], reason=reason))
            continue
        files[suffix] = ListedFile(
            remote_name=remote_name(entry.name, directory),
            local_name=local_name,
            size=entry.size,
            modified_ns=entry.modified_ns,
        )
    records = tuple(
        ListedRecord(name=_stem(files), files=tuple(files[suffix] for suffix in sorted(files)))
        for files in groups.values()
    )
    return Listing(records=records, refused=tuple(refused))


def objection(name: str, directory: str) -> str | None:
    """Why a listed name is not to be trusted; None if it is."""
    local_name = last_component(name)
    parent = _posix(name).rpartition("/")[0]
    if parent.strip("/").upper() not in ("", _posix(directory).strip("/").upper()):
        return f"the file lies outside the directory {directory}"
    if len(name) > LONGEST_NAME:
        return f"the name is longer than {LONGEST_NAME} characters"
    if not local_name.isprintable() or '"' in local_name:
        return "the name holds control characters or quotes"
    if local_name.startswith("."):
        return "the name is hidden or has no stem"
    return None


def last_component(name: str) -> str:
    """Relays separate folders with either slash."""
    return _posix(name).rpartition("/")[2]


def remote_name(name: str, directory: str) -> str:
    """What to ask the relay for: some list full paths, some list bare names."""
    return name if "/" in _posix(name) else f"{directory.rstrip('/')}/{name}"


def _posix(name: str) -> str:
    return name.replace("\\", "/")


def _stem(files: dict[str, ListedFile]) -> str:
    return files[min(files)].local_name.rpartition(".")[0]


def _suffix(local_name: str) -> str:
    _, dot, suffix = local_name.rpartition(".")
    return (dot + suffix).upper()
