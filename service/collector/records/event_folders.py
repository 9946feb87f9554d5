"""Finds the folders in which a relay keeps its event recordings, unless one is configured.

Relays name the folder EVENTS or COMTRADE, in capitals or not, with a slash or backslash before or behind,
and some do not list it at the root; some have both. Folders that hold recordings are read as one; until there
is one, all that exist are looked into.
"""

import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, islice

import structlog

from mms import (
    AccessDenied,
    Client,
    NotFound,
    ProtocolError,
    RequestRejected,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.collector.records.listing import FolderListing, is_of_a_record, last_component, printable
from service.collector.records.policy import RECORD_POLICY, RecordPolicy

log = structlog.get_logger(__name__)

USUAL = ("EVENTS", "COMTRADE")
SPELLINGS = ("/{}", "{}/", "{}\\", "\\{}")
"""These spellings are tried where neither the plain name nor the root's listing leads to a folder."""

ROOT = ""
MOST_FOLDERS = 16
"""So many of the folders that the root lists are looked into."""

MOST_REFUSALS = 10
"""After so many refusals in a row to list it, a folder that was listed before is looked for again."""


@dataclass(frozen=True, slots=True)
class Contents:
    """What the folders in use list; none while there is no folder."""

    folders: tuple[FolderListing, ...] = ()

    @property
    def directory(self) -> str | None:
        """Return the folders' names, for people to read; None while there is no folder."""
        return ", ".join(folder.directory for folder in self.folders) if self.folders else None


class EventFolders:
    """The folders of one relay, read as one. Recordings are in one, in two of the usual names, or deeper.

    default: the folder to be tried first.  override: the only one to be tried.

    `missing` says in words why there is no folder. `no_files` means that the relay has no file service at
    all.
    """

    def __init__(
        self,
        relay: str,
        default: str,
        override: str | None = None,
        *,
        policy: RecordPolicy = RECORD_POLICY,
    ) -> None:
        self._relay = relay
        self._policy = policy
        self._default = default
        self._override = override
        # A folder other than the usual one was set on purpose. It is used where the relay has it, even empty.
        self._configured = override or (None if default == USUAL[0] else default)
        self._candidates: list[str] = []
        self._next_search_s = 0.0
        self._next_look_beside_s = 0.0
        self._refusals: Counter[str] = Counter()
        self.missing: str | None = None
        self.no_files = False

    @property
    def directory(self) -> str | None:
        """Return the folders in use, for people to read; None while there is none."""
        return ", ".join(self._candidates) if self._candidates else None

    def begin(self) -> None:
        """Search again at a new connection, because a folder may be there now."""
        self._next_search_s = self._next_look_beside_s = 0.0

    def contents(self, client: Client, *, expected: bool = False) -> Contents:
        """Return the contents of the folders.

        expected: a report has just said that a record was made, maybe in a folder that was made for it.

        Raises MmsError (the link, or an impossible listing); TemporarilyUnavailable, ServiceFailed where the
        relay cannot list its files for now.
        """
        if expected and not self.no_files:
            latest_s = time.monotonic() + self._policy.expected_search_s
            self._next_search_s = min(self._next_search_s, latest_s)
            self._next_look_beside_s = min(self._next_look_beside_s, latest_s)
        found = self._look_into(client, self._candidates)
        if not found:
            if time.monotonic() < self._next_search_s:
                return Contents()
            found = self._search(client)
        if not found:
            policy = self._policy
            pause_s = policy.no_files_search_s if self.no_files else policy.folder_search_s
            self._next_search_s = time.monotonic() + pause_s
            return Contents()
        self.missing, self.no_files = None, False
        used = self._used(client, found)
        directories = [folder.directory for folder in used]
        if directories != self._candidates:
            log.info("event folders", relay=self._relay, directories=directories)
        self._candidates = directories
        return Contents(tuple(used))

    def listed_now(self, client: Client) -> Contents:
        """List the folders in use once more. Raises MmsError, also where one of them cannot be listed."""
        return Contents(tuple(FolderListing(name, client.files(name)) for name in self._candidates))

    def _used(self, client: Client, found: list[FolderListing]) -> list[FolderListing]:
        """Return the folders to read: those that hold records, or all while none does."""
        configured = [each for each in found if each.directory == self._configured]
        if configured:
            return configured
        holding = _different(filter(_holds_records, found))
        if not holding:
            return found
        if time.monotonic() >= self._next_look_beside_s:
            self._next_look_beside_s = time.monotonic() + self._policy.other_folder_s
            holding = _different(chain(holding, filter(_holds_records, self._beside(client, found))))
        return holding

    def _beside(self, client: Client, found: list[FolderListing]) -> list[FolderListing]:
        """Return the folders of the other usual names."""
        known = {folder.directory.strip("/\\").casefold() for folder in found}
        try:
            return self._look_into(client, [name for name in USUAL if name.casefold() not in known])
        except (ProtocolError, ServiceFailed, TemporarilyUnavailable):
            return []  # one more way to say that there is none
        finally:
            self.no_files = False

    def _look_into(self, client: Client, directories: Iterable[str]) -> list[FolderListing]:
        """Return the folders that exist, up to the one that is configured."""
        found: list[FolderListing] = []
        for directory in directories:
            try:
                folder = FolderListing(directory, client.files(directory))
            except (NotFound, AccessDenied):
                continue
            except ServiceFailed:
                # A folder that was listed before is there, and cannot be listed for now, or has gone.
                if directory in self._candidates:
                    self._refusals[directory] += 1
                    if self._refusals[directory] < MOST_REFUSALS:
                        raise
                continue
            except RequestRejected:
                if directory in self._candidates:
                    raise
                self.no_files = True
                continue
            self._refusals.pop(directory, None)
            found.append(folder)
            if directory == self._configured:
                break
        return found

    def _search(self, client: Client) -> list[FolderListing]:
        self._candidates = []
        self._next_look_beside_s = 0.0
        self.no_files = False
        names = [self._override] if self._override is not None else [*dict.fromkeys((self._default, *USUAL))]
        found = self._look_into(client, names)
        is_settled = any(each.directory == self._configured or _holds_records(each) for each in found)
        if self._override is None and not self.no_files and not is_settled:
            known = {folder.directory for folder in found}
            found += self._look_into(client, [name for name in self._at_root(client) if name not in known])
        if self._override is None and not self.no_files and not found:
            found = self._look_into(client, [form.format(name) for name in names for form in SPELLINGS])
        looked_for = f"looked for {', '.join(names)}"
        self.missing = (
            f"the relay offers no files: no recording can be fetched ({looked_for})"
            if self.no_files
            else f"no directory of event recordings: {looked_for}"
        )
        return found

    def _at_root(self, client: Client) -> Iterator[str]:
        """Yield the folders with recordings or of a usual name that the root lists; maybe the root itself."""
        try:
            entries = client.files(ROOT)
        except (NotFound, AccessDenied, ServiceFailed):
            return
        usual = {name.casefold() for name in (self._default, *USUAL)}
        folders: dict[str, None] = {}
        for entry in entries:
            if printable(entry.name) != entry.name:
                continue
            parent = entry.name[: len(entry.name) - len(last_component(entry.name))].rstrip("/\\")
            plain = entry.name.strip("/\\")
            if is_of_a_record(entry.name):
                folders[parent] = None
            elif plain.casefold() in usual:
                folders[plain] = None
        yield from islice(folders, MOST_FOLDERS)


def _holds_records(folder: FolderListing) -> bool:
    return any(is_of_a_record(entry.name) for entry in folder.entries)


def _different(folders: Iterable[FolderListing]) -> list[FolderListing]:
    """Return the first folder of each contents: some relays list the same files for whatever folder."""
    different: list[FolderListing] = []
    for folder in folders:
        if all(folder.entries != other.entries for other in different):
            different.append(folder)
    return different
