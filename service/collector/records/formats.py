"""One event, one recording, though a relay may write it in several formats.

SEL relays number their events and write each as COMTRADE (HR_10007.CFG, .DAT, .HDR) and as Compressed ASCII,
raw (CR_10007.CEV) and filtered (C4_10007.CEV). GE's UR relays offer each as COMTRADE of floating point
(OSC32F007), binary (OSC16B007) and ASCII (OSCA007). Others give all formats of an event one name.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from service.collector.records.life import Life, RecordState
from service.collector.records.listing import ListedRecord, RefusedFile

_NUMBERED = re.compile(r"(?:HR|C[R0-9]\d?)_(\d{5,})")
_OSCILLOGRAPHY = re.compile(r"OSC(32F|16B|A)(\d+)")
_RAW = "CR_"


@dataclass(frozen=True, slots=True)
class Chosen:
    """The records that are chosen of all that a relay lists.

    states: one for each event.  passed_over: files of the formats that are not taken, and why.
    replaceable: those of `states` whose event is there in another format too that may yet be taken.  early:
    those that are event reports alone while the relay writes COMTRADE as well, which may be still to come.
    """

    states: tuple[RecordState, ...]
    passed_over: tuple[RefusedFile, ...]
    replaceable: frozenset[RecordState]
    early: frozenset[RecordState]


def one_format_an_event(states: Iterable[RecordState]) -> Chosen:
    """Choose one format of each event.

    COMTRADE comes before event reports, and its finest values before others, unless the event is in the
    store in another format. Incomplete records are taken only where there is nothing else. Refused ones
    are not pulled: they stand for their event only where each of its formats is refused. Where two
    folders have a record of one name and format, each folder numbers its own events.
    """
    events: dict[str, list[RecordState]] = {}
    for state in states:
        events.setdefault(_event(state.record), []).append(state)
    writes_comtrade = any(_rank(state.record) < _EVENT_REPORT for same in events.values() for state in same)
    chosen: list[RecordState] = []
    passed_over: list[RefusedFile] = []
    replaceable: set[RecordState] = set()
    for same in (each for listed in events.values() for each in _apart(listed)):
        best = min(same, key=_order)
        chosen.append(best)
        others = [each for each in same if each is not best]
        outcome = "refused, as this is" if best.life is Life.REFUSED else "which is taken"
        reason = f"the same event as {best.record.file_names}, {outcome}"
        passed_over.extend(RefusedFile(other.record.file_names, reason) for other in others)
        if any(other.life not in (Life.REFUSED, Life.INCOMPLETE) for other in others):
            replaceable.add(best)
    return Chosen(
        states=tuple(chosen),
        passed_over=tuple(passed_over),
        replaceable=frozenset(replaceable),
        early=frozenset(
            state for state in chosen if writes_comtrade and _rank(state.record) >= _EVENT_REPORT
        ),
    )


def _apart(same: list[RecordState]) -> Iterator[list[RecordState]]:
    """Yield the records of each folder by themselves, if one of their formats is there twice; else all."""
    formats = Counter((state.name.upper(), _rank(state.record)) for state in same)
    if max(formats.values()) == 1:
        yield same
        return
    folders: dict[str, list[RecordState]] = {}
    for state in same:
        folders.setdefault(state.record.directory, []).append(state)
    yield from folders.values()


def _order(state: RecordState) -> tuple[bool, bool, bool, int, str]:
    """Return what the formats of an event are sorted by. The first is taken."""
    return (
        not state.in_store,
        state.life is Life.REFUSED,
        state.life is Life.INCOMPLETE,
        _rank(state.record),
        state.record.file_names,
    )


def _event(record: ListedRecord) -> str:
    """Return what all formats of one event have in common."""
    name = record.name.upper()
    numbered = _NUMBERED.fullmatch(name)
    if numbered is not None:
        return numbered[1]
    oscillography = _OSCILLOGRAPHY.fullmatch(name)
    return name if oscillography is None else f"OSC {oscillography[2]}"


_FINEST, _COMTRADE, _COARSEST, _COMBINED, _EVENT_REPORT = range(5)


def _rank(record: ListedRecord) -> int:
    """Return the place of a record's format among the formats.

    The order is: COMTRADE (floating point, binary, ASCII, where its name says that), combined COMTRADE,
    event report of raw samples, any other event report, and last a record that holds only what belongs
    beside COMTRADE.
    """
    if record.suffixes & {".CFG", ".DAT"}:
        named = _OSCILLOGRAPHY.fullmatch(record.name.upper())
        return {"32F": _FINEST, "A": _COARSEST}.get(named[1] if named else "", _COMTRADE)
    if ".CFF" in record.suffixes:
        return _COMBINED
    if ".CEV" in record.suffixes:
        return _EVENT_REPORT if record.name.upper().startswith(_RAW) else _EVENT_REPORT + 1
    return _EVENT_REPORT + 2
