"""What a look at a relay's records came to."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from service.collector.records.listing import RefusedFile
from service.storage.records import RemoteRecord


@dataclass(frozen=True, slots=True)
class Scan:
    """What one scan of a relay's directory came to: records as the relay lists them, by what became of them.

    listed: all there are.  taken: names of those newly stored or refused for good.  waiting: new ones that
    are not ready, or are to be tried again soon, or are refused while their event is still to be had in
    another format.  failing: why a pull of them failed, of those that are tried again, soon or late.
    held_back: ready ones that wait for another day.  ignored: files that are not taken, with the reason;
    `ignored_in_all` may be more.  unreachable: why no record could be had at all.  no_folder: why there is
    none at present; a relay may make it with its first record.  busy: why the relay lists no files for now;
    all else is empty then, and nothing is known.
    """

    listed: frozenset[RemoteRecord] = frozenset()
    taken: tuple[str, ...] = ()
    waiting: tuple[RemoteRecord, ...] = ()
    held_back: tuple[RemoteRecord, ...] = ()
    failing: Mapping[RemoteRecord, str] = field(default_factory=dict)
    ignored: tuple[RefusedFile, ...] = ()
    ignored_in_all: int = 0
    unreachable: str | None = None
    no_folder: str | None = None
    busy: str | None = None
