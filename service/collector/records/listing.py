"""Groups the files that a relay's folders list into records, and checks their names.

A relay's file names are hostile until checked here: nothing later makes a local path of them or prints them
raw.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from core.recordings.reading import recording_name

REQUIRED_SUFFIXES = (".CFG", ".DAT")
OPTIONAL_SUFFIXES = (".HDR", ".INF")
WHOLE_SUFFIXES = (".CFF", ".CEV")
"""Each such file is a whole recording: combined COMTRADE of 2013, or Compressed ASCII event report of SEL."""

RECORD_SUFFIXES = REQUIRED_SUFFIXES + OPTIONAL_SUFFIXES + WHOLE_SUFFIXES
LONGEST_NAME = 100
MOST_IGNORED = 100


class FileEntry(Protocol):
    """A remote file as the MMS layer lists it."""

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
class FolderListing:
    """What the relay lists of one folder."""

    directory: str
    entries: Sequence[FileEntry]


@dataclass(frozen=True, slots=True)
class ListedRecord:
    """The files of one recording in one format, as a folder lists them. `name` is their common stem."""

    name: str
    files: tuple[ListedFile, ...]
    directory: str = ""

    @property
    def size_bytes(self) -> int:
        return sum(file.size for file in self.files)

    @property
    def modified_ns(self) -> int:
        """Return the time of the youngest file, by the relay's clock [ns]."""
        return max(file.modified_ns for file in self.files)

    @property
    def missing(self) -> tuple[str, ...]:
        """Return the suffixes that a COMTRADE record needs and this one lacks."""
        if self.suffixes & set(WHOLE_SUFFIXES):
            return ()
        return tuple(suffix for suffix in REQUIRED_SUFFIXES if suffix not in self.suffixes)

    @property
    def suffixes(self) -> frozenset[str]:
        return frozenset(_suffix(file.local_name) for file in self.files)

    @property
    def file_names(self) -> str:
        """Return the names of all files, for people to read."""
        return ", ".join(file.local_name for file in self.files)


@dataclass(frozen=True, slots=True)
class RefusedFile:
    """A listed file that is not touched. `name` is safe to print."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True)
class Listing:
    """The contents of a relay's folders, sorted into records and other files.

    ignored: files that belong to no recording, at most MOST_IGNORED of `ignored_in_all`.
    """

    records: tuple[ListedRecord, ...]
    refused: tuple[RefusedFile, ...]
    ignored: tuple[RefusedFile, ...] = ()
    ignored_in_all: int = 0


def understand(folders: Iterable[FolderListing]) -> Listing:
    """Group the listed files of the folders into records.

    Files whose name cannot be trusted, or that claim another's name, are refused; files of other kinds are
    ignored. So is a record whose files an earlier folder lists with the same names, sizes and times.
    """
    records: dict[tuple[tuple[str, int, int], ...], ListedRecord] = {}
    refused: list[RefusedFile] = []
    ignored: list[RefusedFile] = []
    ignored_in_all = 0
    for folder in folders:
        listing = _understand_one(folder)
        refused += listing.refused
        ignored += listing.ignored
        ignored_in_all += listing.ignored_in_all
        for record in listing.records:
            files = tuple((file.local_name, file.size, file.modified_ns) for file in record.files)
            first = records.setdefault(files, record)
            if first is not record:
                reason = f"in {record.directory} with the same sizes and times as in {first.directory}"
                ignored.append(RefusedFile(record.file_names, reason))
                ignored_in_all += 1
    return Listing(tuple(records.values()), tuple(refused), tuple(ignored[:MOST_IGNORED]), ignored_in_all)


def files_by_name(folders: Iterable[FolderListing]) -> Mapping[str, ListedFile]:
    """Return the files of records that the folders list, by the names to ask the relay for."""
    files = (
        _listed_file(entry, folder.directory)
        for folder in folders
        for entry in folder.entries
        if is_of_a_record(entry.name)
    )
    return {file.remote_name: file for file in files}


def _understand_one(folder: FolderListing) -> Listing:
    directory = folder.directory
    groups: dict[str, dict[str, ListedFile]] = {}
    refused: list[RefusedFile] = []
    ignored: list[RefusedFile] = []
    ignored_in_all = 0
    for entry in folder.entries:
        if not is_of_a_record(entry.name):
            ignored_in_all += 1
            if len(ignored) < MOST_IGNORED:
                ignored.append(RefusedFile(printable(entry.name), _why_ignored(entry.name)))
            continue
        local_name = kept_name(entry.name)
        suffix = _suffix(local_name)
        reason = objection(entry.name, directory)
        stem = local_name[: -len(suffix)].upper()
        group = f"{stem}{suffix}" if suffix in WHOLE_SUFFIXES else stem
        files = groups.setdefault(group, {}) if reason is None else {}
        if reason is None and suffix in files:
            reason = "the relay lists two files of this name"
        if reason is not None:
            refused.append(RefusedFile(name=ascii(entry.name)[:LONGEST_NAME], reason=reason))
            continue
        files[suffix] = _listed_file(entry, directory)
    records = tuple(
        ListedRecord(_stem(files), tuple(files[suffix] for suffix in sorted(files)), directory)
        for files in groups.values()
    )
    return Listing(records, tuple(refused), tuple(ignored), ignored_in_all)


def _listed_file(entry: FileEntry, directory: str) -> ListedFile:
    return ListedFile(
        remote_name=remote_name(entry.name, directory),
        local_name=kept_name(entry.name),
        size=entry.size,
        modified_ns=entry.modified_ns,
    )


def is_of_a_record(name: str) -> bool:
    """Return whether a file, by its name alone, belongs to a recording."""
    return _suffix(kept_name(name)) in RECORD_SUFFIXES


def printable(name: str) -> str:
    """Return a relay's file name in a form that is safe to print."""
    return name if name.isprintable() and len(name) <= LONGEST_NAME else ascii(name)[:LONGEST_NAME]


def _why_ignored(name: str) -> str:
    if not last_component(name):
        return "a folder: not looked into"
    return "no file of a recording (.CFG with .DAT, .CFF, .CEV)"


def objection(name: str, directory: str) -> str | None:
    """Return why a listed name is not to be trusted; None if it is."""
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
    """Return the name without its folders. Relays separate them with either slash."""
    return _posix(name).rpartition("/")[2]


def kept_name(name: str) -> str:
    """Return the name to keep a file under: of an event report C8_10001.TXT, that is C8_10001.CEV."""
    return recording_name(last_component(name))


def remote_name(name: str, directory: str) -> str:
    """Return the name to ask the relay for: some relays list full paths, some list bare names."""
    if "/" in _posix(name) or not directory.strip("/\\"):
        return name
    slash = "\\" if directory.endswith("\\") else "/"
    return directory.rstrip("/\\") + slash + name


def _posix(name: str) -> str:
    return name.replace("\\", "/")


def _stem(files: dict[str, ListedFile]) -> str:
    return files[min(files)].local_name.rpartition(".")[0]


def _suffix(local_name: str) -> str:
    _, dot, suffix = local_name.rpartition(".")
    return (dot + suffix).upper()
