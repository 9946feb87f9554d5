"""One event, one recording, though a relay may write it in several formats.

SEL relays number their events and write each as COMTRADE (HR_10007.CFG, .DAT, .HDR) and as Compressed ASCII,
raw (CR_10007.CEV) and filtered (C4_10007.CEV); others give all formats of an event one name.
"""

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from service.collector.records.listing import ListedRecord, RefusedFile
from service.storage.records import RemoteRecord

_NUMBERED = re.compile(r"(?:HR|C[R0-9]\d?)_(\d{5,})")
_RAW = "CR_"


@dataclass(frozen=True, slots=True)
class Chosen:
    """records: one for each event.  passed_over: files of the formats that are not taken, and why.

    replaceable: those of `records` whose event is there in another format too that may yet be taken.  early:
    those that are event reports alone while the relay writes COMTRADE as well, which may be still to come.
    """

    records: tuple[ListedRecord, ...]
    passed_over: tuple[RefusedFile, ...]
    replaceable: frozenset[ListedRecord]
    early: frozenset[ListedRecord]


def one_format_an_event(
    records: Iterable[ListedRecord],
    stored: Collection[RemoteRecord],
    refused: Collection[RemoteRecord],
    hopeless: Collection[ListedRecord],
) -> Chosen:
    """COMTRADE before event reports, unless the event was taken otherwise before (stored).

    hopeless: those that have proved incomplete; taken only where there is nothing else.  refused: those that
    are not pulled; they stand for their event only where each of its formats is refused.
    """
    events: dict[str, list[ListedRecord]] = {}
    for record in records:
        events.setdefault(_event(record), []).append(record)
    writes_comtrade = any(_rank(record) < _EVENT_REPORT for same in events.values() for record in same)
    chosen: list[ListedRecord] = []
    passed_over: list[RefusedFile] = []
    replaceable: set[ListedRecord] = set()
    for same in events.values():
        best = min(
            same,
            key=lambda each: (
                remote_of(each) not in stored,
                remote_of(each) in refused,
                each in hopeless,
                _rank(each),
                each.file_names,
            ),
        )
        chosen.append(best)
        others = [each for each in same if each is not best]
        fate = "refused, as this is" if remote_of(best) in refused else "which is taken"
        reason = f"the same event as {best.file_names}, {fate}"
        passed_over.extend(RefusedFile(other.file_names, reason) for other in others)
        if any(remote_of(other) not in refused and other not in hopeless for other in others):
            replaceable.add(best)
    return Chosen(
        records=tuple(chosen),
        passed_over=tuple(passed_over),
        replaceable=frozenset(replaceable),
        early=frozenset(record for record in chosen if writes_comtrade and _rank(record) >= _EVENT_REPORT),
    )


def remote_of(record: ListedRecord) -> RemoteRecord:
    """A listed record as it is remembered."""
    return RemoteRecord(record.name, record.size_bytes, record.modified_ns)


def _event(record: ListedRecord) -> str:
    """What all formats of one event have in common."""
    name = record.name.upper()
    numbered = _NUMBERED.fullmatch(name)
    return name if numbered is None else numbered[1]


_EVENT_REPORT = 2


def _rank(record: ListedRecord) -> int:
    """COMTRADE, COMTRADE combined, event report of raw samples, any other, what belongs to COMTRADE alone."""
    if record.suffixes & {".CFG", ".DAT"}:
        return 0
    if ".CFF" in record.suffixes:
        return 1
    if ".CEV" in record.suffixes:
        return _EVENT_REPORT if record.name.upper().startswith(_RAW) else _EVENT_REPORT + 1
    return _EVENT_REPORT + 2
