"""Finds the folder in which a relay keeps its event recordings, unless it is configured.

Relays name the folder EVENTS or COMTRADE, in capitals or not, with a slash or backslash before or behind,
and some do not list it at the root. A folder that was once seen to hold recordings is the one; until then all
that exist are looked into.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import structlog

from mms import (
    AccessDenied,
    Client,
    FileEntry,
    NotFound,
    ProtocolError,
    RequestRejected,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.collector.records.listing import is_of_a_record, last_component, printable
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
    """What a folder lists. `directory` is None while there is no folder."""

    directory: str | None
    entries: tuple[FileEntry, ...]


class EventFolder:
    """The folder of one relay. default: the folder to be tried first.  override: the only one to be tried.

    `missing` says in words why there is no folder. `no_files` means that the relay has no file service at
    all. `unread` says that recordings of the relay are not fetched, because they are in a second folder.
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
        self._is_sure = False
        self._look_beside = False
        self._next_search_s = 0.0
        self._refusals = 0
        self.missing: str | None = None
        self.unread: str | None = None
        self.no_files = False

    @property
    def directory(self) -> str | None:
        """Return the folder in use, None while there is none."""
        return self._candidates[0] if self._candidates else None

    def begin(self) -> None:
        """Search again at a new connection, because a folder may be there now."""
        self._next_search_s = 0.0
        self._look_beside = True

    def contents(self, client: Client, *, expected: bool = False) -> Contents:
        """Return the contents of the folder.

        expected: a report has just said that a record was made, maybe in a folder that was made for it.

        Raises MmsError (the link, or an impossible listing); TemporarilyUnavailable, ServiceFailed where the
        relay cannot list its files for now.
        """
        if expected and not self.no_files:
            latest_s = time.monotonic() + self._policy.expected_search_s
            self._next_search_s = min(self._next_search_s, latest_s)
        found = [] if not self._candidates else self._look_into(client, self._candidates)
        if not found:
            self._is_sure = False
            self._look_beside = True
            self.unread = None
            if time.monotonic() < self._next_search_s:
                return Contents(None, ())
            found = self._search(client)
        if not found:
            policy = self._policy
            pause_s = policy.no_files_search_s if self.no_files else policy.folder_search_s
            self._next_search_s = time.monotonic() + pause_s
            return Contents(None, ())
        self.missing, self.no_files = None, False
        configured = [each for each in found if each.directory == self._configured]
        chosen = next(filter(_holds_records, configured or found), (configured or found)[0])
        if _holds_records(chosen) or configured:
            self._is_sure = True
        if chosen.directory != self.directory:
            log.info("events directory", relay=self._relay, directory=chosen.directory)
        others = [] if self._is_sure else [each.directory for each in found if each is not chosen]
        self._candidates = [each for each in (chosen.directory, *others) if each is not None]
        if self._look_beside:
            self._look_beside = not self._is_sure
            self._note_unread(client, chosen)
        return chosen

    def _note_unread(self, client: Client, chosen: Contents) -> None:
        """Note whether another folder of a usual name holds recordings too, unless one was configured."""
        self.unread = None
        if self._configured is not None or not _holds_records(chosen):
            return
        names = [
            name for name in USUAL if name.casefold() != (chosen.directory or "").strip("/\\").casefold()
        ]
        try:
            others = [each for each in self._look_into(client, names) if _holds_records(each)]
        except (ProtocolError, ServiceFailed, TemporarilyUnavailable):
            return  # one more way to say that there is none
        finally:
            self.no_files = False
        # Some relays list the same files whatever folder they are asked for.
        beside = [each.directory or "" for each in others if each.entries != chosen.entries]
        if beside:
            self.unread = (
                f"recordings in {', '.join(beside)} are not fetched, only those in {chosen.directory}; "
                "events_directory in the motors file names the one to be read"
            )
            log.warning("another events directory", relay=self._relay, reason=self.unread)

    def _look_into(self, client: Client, directories: list[str]) -> list[Contents]:
        """Return the folders that exist, up to the first that holds recordings."""
        found: list[Contents] = []
        for directory in directories:
            try:
                contents = Contents(directory, client.files(directory))
            except (NotFound, AccessDenied):
                continue
            except ServiceFailed:
                # A folder that was listed before is there, and cannot be listed for now, or has gone.
                if directory in self._candidates:
                    self._refusals += 1
                    if self._refusals < MOST_REFUSALS:
                        raise
                continue
            except RequestRejected:
                if directory in self._candidates:
                    raise
                self.no_files = True
                continue
            self._refusals = 0
            found.append(contents)
            if directory == self._configured or _holds_records(contents):
                break
        return found

    def _search(self, client: Client) -> list[Contents]:
        self._candidates = []
        self.no_files = False
        names = [self._override] if self._override is not None else [*dict.fromkeys((self._default, *USUAL))]
        found = self._look_into(client, names)
        is_settled = any(each.directory == self._configured or _holds_records(each) for each in found)
        if self._override is None and not self.no_files and not is_settled:
            known = {contents.directory for contents in found}
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


def _holds_records(contents: Contents) -> bool:
    return any(is_of_a_record(entry.name) for entry in contents.entries)
