"""What became of one file: how it was read, and whether another reader finds the same in it."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

LONGEST_NOTE = 400
"""Messages quote what files hold; more of it is not shown."""


class Reading(StrEnum):
    """How the project read a file."""

    READ = "read"
    WARNED = "read with warnings"
    LENIENT = "read only leniently"
    REFUSED = "refused"
    CRASHED = "crashed"
    """An error that is no refusal, or a limit of time or memory: a defect of the reader."""


class Agreement(StrEnum):
    """What the comparison with another reader says."""

    AGREES = "agrees"
    EXPLAINED = "differs as documented"
    """In what docs/reference pages say: units, ratios, time zones."""
    DIFFERS = "differs"
    PEER_FAILS = "the other fails"
    NOT_COMPARED = "not compared"


@dataclass(frozen=True, slots=True)
class Outcome:
    """How one file was read. notes: warnings, what was mended, or the reason of a refusal."""

    reading: Reading
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Comparison:
    """Whether another reader finds the same in a file. notes: what differs, or how it fails."""

    agreement: Agreement
    notes: tuple[str, ...] = ()


class Service(StrEnum):
    """Whether ied-sim serves a relay of a file."""

    WHOLE = "served whole"
    """Its names are those of the file, as another reader lists them."""
    IN_PART = "served in part"
    NOT_SERVED = "not served"
    NOT_TRIED = "not tried"
    CRASHED = "crashed"


@dataclass(frozen=True, slots=True)
class Served:
    """Whether one relay is served. notes: what is missing, or why it is not."""

    relay: str
    service: Service
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of file.

    suffixes: of the files that are read, in lower case. parts: suffixes of files that belong to one of those.
    read: reads one file; it raises only where the reader has a defect. compare: reads it with another reader
    too, where the project's has read it. peer: name of the other reader. serve: serves its relays, where the
    project has read it. These functions run in worker processes, so they are defined at the top of a module.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[Path], Outcome]
    compare: Callable[[Path], Comparison] | None = None
    peer: str = ""
    parts: tuple[str, ...] = ()
    serve: Callable[[Path], tuple[Served, ...]] | None = None


@dataclass(frozen=True, slots=True)
class Examined:
    """One file of the folder, with what became of it. seconds: the time of the project's reading."""

    path: str
    kind: str
    outcome: Outcome
    comparison: Comparison
    seconds: float
    served: tuple[Served, ...] = ()


def alike(note: str) -> str:
    """A note without names, references and figures: notes that differ in these only are alike."""
    return re.sub(r"'[^']*'|\"[^\"]*\"|\S+/\S+|[-+]?\d[\d.e+-]*", "*", note)


def shortened(text: str) -> str:
    """A note on one line, without what a terminal or a table would take for more than text."""
    line = "".join(character if character.isprintable() else " " for character in text).strip()
    return line if len(line) <= LONGEST_NOTE else line[: LONGEST_NOTE - 3] + "..."
