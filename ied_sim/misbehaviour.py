"""Faulty behaviour of a relay or its network, switched on by time or by a control."""

import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum
from math import inf


class Kind(StrEnum):
    """Kinds of misbehaviour; docs/reference/simulator.md tells what each does."""

    SLOW_REPLIES = "slow-replies"
    CUT_MID_FILE = "cut-mid-file"
    GROWING_FILE = "growing-file"
    PARTIAL_LISTING = "partial-listing"
    WRONG_SIZE = "wrong-size"
    NAMES_WITHOUT_PATH = "names-without-path"
    NAMES_WITH_PATH = "names-with-path"
    REPORT_TAKEN = "report-taken"
    BUFFER_OVERFLOW = "buffer-overflow"
    EMPTY_RPTID = "empty-rptid"
    CLOCK_OFFSET = "clock-offset"
    LOCAL_TIME = "local-time"
    RESTART = "restart"
    REFUSED_CONTROL = "refused-control"
    FEW_SESSIONS = "few-sessions"
    FROZEN = "frozen"
    FILES_BUSY = "files-busy"
    RECORD_REPLACED = "record-replaced"
    TWO_FOLDERS = "two-folders"
    READS_BUSY = "reads-busy"
    UNREADABLE_MEASURAND = "unreadable-measurand"
    REPORT_OPTFIELDS_READONLY = "report-optfields-readonly"
    REPORT_WITHOUT_DATA_SET = "report-without-data-set"


PARAMETERS: dict[Kind, tuple[str, float]] = {
    Kind.SLOW_REPLIES: ("delay_s", 2.0),
    Kind.CUT_MID_FILE: ("after_bytes", 1000.0),
    Kind.GROWING_FILE: ("grow_s", 3.0),
    Kind.PARTIAL_LISTING: ("entries", 2.0),
    Kind.WRONG_SIZE: ("by_bytes", 7.0),
    Kind.RECORD_REPLACED: ("times", 1.0),
    Kind.CLOCK_OFFSET: ("offset_s", 3600.0),
    Kind.LOCAL_TIME: ("offset_s", 3600.0),
    Kind.FEW_SESSIONS: ("sessions", 1.0),
    Kind.UNREADABLE_MEASURAND: ("error", 1.0),
    Kind.REPORT_OPTFIELDS_READONLY: ("fields", 5.0),
}
"""The one number some kinds have: its name and what it is where none is given."""

MADE_BY_PROXY = frozenset(
    {
        Kind.SLOW_REPLIES,
        Kind.CUT_MID_FILE,
        Kind.PARTIAL_LISTING,
        Kind.WRONG_SIZE,
        Kind.NAMES_WITHOUT_PATH,
    }
    | {
        Kind.NAMES_WITH_PATH,
        Kind.EMPTY_RPTID,
        Kind.FEW_SESSIONS,
        Kind.FROZEN,
        Kind.READS_BUSY,
    }
)
"""Kinds that are made between client and server; the others the relay makes itself."""

BUILT_IN = frozenset({Kind.REPORT_OPTFIELDS_READONLY, Kind.REPORT_WITHOUT_DATA_SET})
"""Kinds that belong to the relay's data model and cannot come and go."""


@dataclass(frozen=True, slots=True)
class Misbehaviour:
    """One kind of misbehaviour and when it is on.

    It comes on at `at_s` [s], or when the control `switch` rises, and stays on for `for_s` [s]. It ends
    earlier when the control falls. With `at_s` None the control alone switches it. `number` is the number
    that some kinds have.
    """

    kind: Kind
    number: float = 0.0
    at_s: float | None = None
    for_s: float = inf
    switch: str | None = None


class MisbehaviourState:
    """Tells which kinds of misbehaviour are on at present.

    `clock` gives the seconds since the simulator's start. Several threads may use this.
    """

    def __init__(self, known: Iterable[Misbehaviour], clock: Callable[[], float]) -> None:
        self._known = tuple(known)
        self._clock = clock
        self._lock = threading.Lock()
        self._risen: dict[str, float] = {}

    def built_in(self, kind: Kind) -> float | None:
        """Return the number of a kind that the relay is built with, None where it is built without."""
        return next((each.number for each in self._known if each.kind is kind), None)

    @property
    def kinds(self) -> frozenset[Kind]:
        """All kinds that may come on at some time."""
        return frozenset(each.kind for each in self._known)

    def switches(self) -> frozenset[str]:
        """Return the controls that switch a kind."""
        return frozenset(each.switch for each in self._known if each.switch is not None)

    def switch(self, control: str, *, on: bool) -> None:
        """Note that a control has been operated."""
        with self._lock:
            if on:
                self._risen.setdefault(control, self._clock())
            else:
                self._risen.pop(control, None)

    def number(self, kind: Kind) -> float | None:
        """Return the number of a kind that is on, None while it is off."""
        for each in self._known:
            if each.kind is kind and self._is_on(each):
                return each.number
        return None

    def is_on(self, kind: Kind) -> bool:
        """Tell whether a kind is on."""
        return self.number(kind) is not None

    def _is_on(self, each: Misbehaviour) -> bool:
        with self._lock:
            risen_s = None if each.switch is None else self._risen.get(each.switch)
        begins = [begin for begin in (each.at_s, risen_s) if begin is not None]
        now_s = self._clock()
        return any(begin <= now_s < begin + each.for_s for begin in begins)
