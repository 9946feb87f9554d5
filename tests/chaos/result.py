"""What a run came to, as a document."""

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median

from tests.chaos.account import Folder
from tests.chaos.evidence import Evidence
from tests.chaos.ledger import RelayRecord
from tests.chaos.order import Order
from tests.chaos.schedule import faults_by_kind

BREACHES_WITH_HISTORY = 50


@dataclass(frozen=True, slots=True)
class Result:
    """Figures of a run. lost, doubled and falsified count the breaches of their kinds."""

    seed: int
    minutes: float
    recordings_asked: int
    relays: int
    profiles: Mapping[str, int]
    command: str
    disk: str
    passed: bool
    records_made: int
    records_stored: int
    half_records: int
    lost: int
    doubled: int
    falsified: int
    breaches: Sequence[str]
    around: Sequence[Sequence[str]]
    faults: Mapping[str, int]
    event_reports: Mapping[str, int]
    failed_because: Mapping[str, int]
    triggers_repeated: int
    pulled_bytes: int
    made_to_stored_s: Mapping[str, float]
    settled_after_s: float
    lasted_s: float
    integrity: str
    files_and_threads: Mapping[str, Sequence[int]]
    open_matters: Sequence[str]

    def write(self, path: Path) -> None:
        path.write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")


def result_of(order: Order, profiles: Mapping[str, int], disk: str, evidence: Evidence) -> Result:
    """The figures, and every breach with what was done around it."""
    breaches = evidence.breaches()
    kinds = Counter(breach.kind for breach in breaches)
    whole = sum(record.is_whole for record in evidence.truth)
    reasons = [request.reason for request in evidence.requests if request.state == "failed"]
    return Result(
        seed=order.seed,
        minutes=order.minutes,
        recordings_asked=order.recordings,
        relays=order.relays,
        profiles=profiles,
        command=order.command,
        disk=disk,
        passed=not breaches,
        records_made=whole,
        records_stored=len({(row.relay, row.name) for row in evidence.rows if row.is_fetched}),
        half_records=len(evidence.truth) - whole,
        lost=kinds["lost"],
        doubled=kinds["doubled"],
        falsified=kinds["falsified"],
        breaches=[str(breach) for breach in breaches],
        around=[evidence.history.around(breach.made_ns) for breach in breaches[:BREACHES_WITH_HISTORY]],
        faults=faults_by_kind(evidence.schedule),
        event_reports=dict(Counter(request.state for request in evidence.requests)),
        failed_because=_by_kind(reasons),
        triggers_repeated=sum(asked.tries - 1 for asked in evidence.triggers.asked.values()),
        pulled_bytes=evidence.pulled_bytes,
        made_to_stored_s=_delays_s(evidence.truth, evidence.store),
        settled_after_s=round(evidence.settled_after_s, 1),
        lasted_s=round(evidence.lasted_s, 1),
        integrity=evidence.integrity,
        files_and_threads={
            role: [*at_first, *evidence.at_last[role]] for role, at_first in evidence.at_first.items()
        },
        open_matters=evidence.open_matters,
    )


def _delays_s(truth: Iterable[RelayRecord], store: Iterable[Folder]) -> dict[str, float]:
    """From a record's last file in its relay to its folder in the store: median, 95th percentile, longest."""
    stored_ns = {frozenset(folder.files.items()): folder.stored_ns for folder in store}
    found = []
    for record in truth:
        contents = (record.files, record.comtrade())
        there_ns = next((t for t in (stored_ns.get(frozenset(c.items())) for c in contents) if t), None)
        if there_ns is not None and record.made_ns is not None:
            found.append((there_ns - record.made_ns) * 1e-9)
    if not found:
        return {}
    found.sort()
    p95 = found[min(len(found) - 1, round(0.95 * len(found)))]
    return {"median": round(median(found), 2), "p95": round(p95, 2), "longest": round(found[-1], 2)}


def _by_kind(reasons: Iterable[str]) -> dict[str, int]:
    """How often each reason, without names and figures."""
    words = ("expected a record", "does not answer", "is not visited", "refuses the trigger", "expected a .")
    return dict(Counter(next((w for w in words if w in reason), reason) for reason in reasons))
