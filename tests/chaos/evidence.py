"""What a run leaves behind: the truth, the account, and what was noticed on the way."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tests.chaos.account import Folder, Request, Row
from tests.chaos.history import History
from tests.chaos.ledger import File, Ledger, RelayRecord
from tests.chaos.schedule import Action
from tests.chaos.triggers import Triggers
from tests.chaos.verdict import Breach, of_contents, of_records, of_triggers

FILES_SLACK = THREADS_SLACK = 16
"""Open files and threads of a role's processes may differ by so many at the end: connections come and go."""

Handles = Mapping[str, tuple[int, int]]
"""Open files and threads by role."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """told: files of each recording as REST tells them.  noticed: what went wrong while it ran.

    left_arriving: names of what lies half arrived in the store.  exit_code: of the service at its end.
    """

    schedule: Sequence[Action]
    history: History
    ledger: Ledger
    triggers: Triggers
    truth: Sequence[RelayRecord]
    rows: Sequence[Row]
    requests: Sequence[Request]
    told: Mapping[str, Mapping[str, File]]
    store: Sequence[Folder]
    left_arriving: Sequence[str]
    at_first: Handles
    at_last: Handles
    exit_code: int | None
    integrity: str
    diagnosed_twice: Sequence[str]
    noticed: Sequence[str]
    open_matters: Sequence[str]
    pulled_bytes: int
    settled_after_s: float
    lasted_s: float

    def breaches(self) -> list[Breach]:
        """All that must not be."""
        return [
            *(Breach("process", "", "", what) for what in self.noticed),
            *of_records(self.truth, self.rows, self.ledger),
            *of_contents(self.truth, self.rows, self.told, self.store, self.ledger),
            *of_triggers(self.triggers, self.requests, self.truth, self.rows),
            *(Breach("leftover", "", name, "half arrived, and never removed") for name in self.left_arriving),
            *self._of_processes(),
            *(Breach("doubled", "", "diagnosis", what) for what in self.diagnosed_twice),
            *([] if self.integrity == "ok" else [Breach("integrity", "", "database", self.integrity)]),
        ]

    def _of_processes(self) -> list[Breach]:
        found = [
            Breach("growth", "", role, what) for role, what in growth(self.at_first, self.at_last).items()
        ]
        if self.exit_code != 0:
            found.append(Breach("process", "", "service", f"SIGTERM ended it with {self.exit_code}, not 0"))
        return found


def growth(before: Handles, after: Handles) -> dict[str, str]:
    """Roles whose processes have markedly more open files or threads than before, and how many."""
    grown = {}
    for role, (files, threads) in after.items():
        files_before, threads_before = before[role]
        if files > files_before + FILES_SLACK or threads > threads_before + THREADS_SLACK:
            grown[role] = f"{files_before} open files became {files}, {threads_before} threads {threads}"
    return grown
