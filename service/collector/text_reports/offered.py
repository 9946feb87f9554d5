"""Which text reports a relay lists in a folder. A name that is not one of these is never asked for."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from core.relay_reports import ReportKind
from service.collector.records.listing import FileEntry, last_component, objection, remote_name

_NAMES: Final[Mapping[str, ReportKind]] = {
    "SER": ReportKind.SEQUENCE_OF_EVENTS,
    "CSER": ReportKind.SEQUENCE_OF_EVENTS,
    "LDP": ReportKind.LOAD_PROFILE,
    "CLDP": ReportKind.LOAD_PROFILE,
    "MSR": ReportKind.MOTOR_STARTS,
    "MOT": ReportKind.MOTOR_STATISTICS,
}
"""Files by their names without TXT, the better one of a kind last: it has checksums, and dates in words."""


@dataclass(frozen=True, slots=True)
class OfferedReport:
    """A text report that a relay lists.

    name: its own, known and safe to print.  remote_name: the name to ask the relay for.
    is_compressed: Compressed ASCII, whose dates are read alike in any order.
    """

    kind: ReportKind
    name: str
    remote_name: str
    size: int
    modified_ns: int

    @property
    def is_compressed(self) -> bool:
        """Tell whether it is Compressed ASCII."""
        return self.name.startswith("C")


def offered_reports(entries: Iterable[FileEntry], directory: str) -> dict[ReportKind, OfferedReport]:
    """Return the text reports of a folder's listing, one a kind; of a name that is there twice, the first."""
    listed: dict[str, OfferedReport] = {}
    for entry in entries:
        stem, dot, suffix = last_component(entry.name).upper().partition(".")
        is_text = stem in _NAMES and (suffix == "TXT" or not dot)
        if is_text and entry.name.isascii() and objection(entry.name, directory) is None:
            asked = remote_name(entry.name, directory)
            listed.setdefault(stem, OfferedReport(_NAMES[stem], stem, asked, entry.size, entry.modified_ns))
    return {_NAMES[stem]: listed[stem] for stem in _NAMES if stem in listed}
