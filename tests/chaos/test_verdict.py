"""The chaos suite's own checks can fail: each kind of harm, done to a plant where all is well, is told."""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from tests.chaos.account import Folder, Request, Row
from tests.chaos.ledger import File, Ledger, RelayRecord
from tests.chaos.plant import make_plant
from tests.chaos.schedule import make_schedule
from tests.chaos.track_record import FAULTS, FOLDER, HEADER, RUNS, write
from tests.chaos.triggers import Asked, Triggers
from tests.chaos.verdict import of_contents, of_records, of_triggers

FILES = {"HR_1.CFG": File(1, "c" * 64), "HR_1.DAT": File(2, "d" * 64)}
RECORD = RelayRecord("R01", "HR_1", FILES, made_ns=1)
ROW = Row("row", "R01", "HR_1", "diagnosed", "", is_fetched=True)
REQUEST = Request("request", "R01", "diagnosed", "", "row", was_triggered=True)
STORE = [Folder(Path("aa"), FILES, 2)]


class WatchfulLedger:
    """Saw nothing but what is there."""

    def discarded(self) -> set[tuple[str, str]]:
        return set()

    def changed(self, _key: tuple[str, str]) -> bool:
        return False


LEDGER = cast("Ledger", WatchfulLedger())


def triggers(*asked: Asked, made: int = 0) -> Triggers:
    told = SimpleNamespace(
        asked={each.key: each for each in asked},
        unanswered=set(),
        contradictions=[],
        made=Counter({"R01": made}),
    )
    return cast("Triggers", told)


ASKED = Asked("key", "R01", "MOTOR-01", "request", 1)


def test_where_all_is_well_nothing_is_told() -> None:
    assert list(of_records([RECORD], [ROW], LEDGER)) == []
    assert list(of_contents([RECORD], [ROW], {"row": FILES}, STORE, LEDGER)) == []
    assert list(of_triggers(triggers(ASKED), [REQUEST], [RECORD], [ROW])) == []


@pytest.mark.parametrize(
    ("rows", "kind"),
    [
        ([], "lost"),
        ([replace(ROW, is_fetched=False, state="rejected", reason="too large")], "lost"),
        ([ROW, replace(ROW, id="other")], "doubled"),
        ([ROW, replace(ROW, name="HR_2")], "foreign"),
        ([replace(ROW, state="fetched")], "unsettled"),
        ([replace(ROW, state="failed", reason="the worker died")], "undiagnosed"),
        ([ROW, replace(ROW, is_fetched=False, state="rejected", reason="no reason")], "refused"),
    ],
)
def test_what_is_lost_doubled_or_foreign_is_told(rows: list[Row], kind: str) -> None:
    assert kind in {breach.kind for breach in of_records([RECORD], rows, LEDGER)}


def test_half_a_record_must_be_refused() -> None:
    half = replace(RECORD, files={"HR_1.DAT": File(2, "d" * 64)})
    reason = "HR_1: expected a .CFG file in EVENTS, found none"
    refused = replace(ROW, is_fetched=False, state="rejected", reason=reason)
    assert list(of_records([half], [refused], LEDGER)) == []
    assert {breach.kind for breach in of_records([half], [], LEDGER)} == {"unaccounted"}


@pytest.mark.parametrize(
    ("told", "store", "kind"),
    [
        (FILES | {"HR_1.DAT": File(2, "e" * 64)}, STORE, "falsified"),
        (
            {"HR_1.CFG": FILES["HR_1.CFG"]},
            [Folder(Path("aa"), {"HR_1.CFG": FILES["HR_1.CFG"]}, 2)],
            "falsified",
        ),
        (FILES, [], "falsified"),
        (FILES, [*STORE, *STORE], "falsified"),
        (FILES, [*STORE, Folder(Path("bb"), {"HR_9.CFG": File(1, "f" * 64)}, 2)], "orphan"),
    ],
)
def test_other_content_is_told(told: dict[str, File], store: list[Folder], kind: str) -> None:
    assert kind in {breach.kind for breach in of_contents([RECORD], [ROW], {"row": told}, store, LEDGER)}


@pytest.mark.parametrize(
    ("requests", "made", "kind"),
    [
        ([], 1, "lost"),
        (
            [REQUEST, replace(REQUEST, id="other", recording=None, state="failed", reason="a .* b")],
            0,
            "doubled",
        ),
        ([replace(REQUEST, state="triggered")], 0, "unsettled"),
        ([replace(REQUEST, state="failed", reason="")], 0, "reason"),
        ([replace(REQUEST, recording="of another")], 1, "contradiction"),
        ([replace(REQUEST, was_triggered=False)], 0, "doubled"),
        (
            [
                replace(
                    REQUEST,
                    state="failed",
                    reason="expected a record within 15 s, found none",
                    recording=None,
                )
            ],
            0,
            "unmatched",
        ),
    ],
)
def test_triggers_that_do_not_add_up_are_told(requests: list[Request], made: int, kind: str) -> None:
    found = of_triggers(triggers(ASKED, made=made), requests, [RECORD], [ROW])
    assert kind in {breach.kind for breach in found}


def test_a_seed_is_a_schedule(tmp_path: Path) -> None:
    plant = make_plant(tmp_path, 5)
    first, again, other = (
        make_schedule(plant, seed=seed, length_s=60.0, recordings=50) for seed in (1, 1, 2)
    )
    assert first == again
    assert first != other


def test_runs_are_written_as_the_page_has_them(tmp_path: Path) -> None:
    result = {
        "command": "make chaos SEED=1", "profiles": {"rdre": 2}, "faults": {"link-cut": 3, "disk-full": 1},
        "records_made": 7, "half_records": 0, "lost": 0, "doubled": 0, "falsified": 0, "breaches": [],
        "pulled_bytes": 1_500_000, "made_to_stored_s": {"median": 0.5, "p95": 2.0, "longest": 3.0},
        "integrity": "ok",
    }  # fmt: skip
    write(tmp_path, [result])

    header, row = (tmp_path / RUNS).read_text(encoding="utf-8").splitlines()
    assert header == (FOLDER / RUNS).read_text(encoding="utf-8").splitlines()[0]
    assert header.count(",") >= len(HEADER) - 1
    assert row.startswith("make chaos SEED=1,2 rdre,4,")
    assert (tmp_path / FAULTS).read_text(encoding="utf-8").split() == [
        "fault,times",
        "link-cut,3",
        "disk-full,1",
    ]
