"""What a look at a relay's records came to."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from service.collector.records.listing import RefusedFile


@dataclass(frozen=True, slots=True)
class Scan:
    """What one scan of a relay's directory came to: names of records, by what became of them.

    listed: all there are.  taken: newly stored or refused for good.  waiting: new ones that are not ready, or
    are to be tried again soon, or are refused while their event is still to be had in another format.
    failing: why a pull of them failed, by names, of those that are tried again, soon or late.  held_back:
    ready ones that wait for another day.  ignored: files that are not taken, with the reason;
    `ignored_in_all` may be more.  unreachable: why no record could be had at all.  no_folder: why there is
    none at present; a relay may make it with its first record.  busy: why the relay lists no files for now;
    all else is empty then, and nothing is known.
    """

    listed: frozenset[str] = frozenset()
    taken: tuple[str, ...] = ()
    waiting: tuple[str, ...] = ()
    held_back: tuple[str, ...] = ()
    failing: Mapping[str, str] = field(default_factory=dict)
    ignored: tuple[RefusedFile, ...] = ()
    ignored_in_all: int = 0
    unreachable: str | None = None
    no_folder: str | None = None
    busy: str | None = None
