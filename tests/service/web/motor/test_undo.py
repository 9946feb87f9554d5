"""Who reset a baseline, or retracted a note, undoes it by a click for ten minutes; nobody else does."""

from dataclasses import replace

import httpx
import pytest

from core.condition.events import EventKind
from service.api.conditions.undo import latest_to_undo, may_undo
from service.storage import Repository
from service.storage.records import ConditionEvent
from service.timing.undo_time import UNDO_NS
from testing.service.plants import NOW_NS
from tests.service.web.pages import addresses, page

HERE = "/motors/PUMP-A1"
NOTE = ConditionEvent("1", "PUMP-A1", NOW_NS, EventKind.REFERENCE_RESTARTED, "tested", "ann", "ann", NOW_NS)
UNDO = "form[action$='/undo']"


def notes(repository: Repository) -> list[ConditionEvent]:
    """Those that count, the latest first."""
    found = repository.events("PUMP-A1", limit=10).items
    return [note for note in found if note.withdrawn_ns is None]


def test_a_baseline_that_was_reset_by_mistake_is_back_by_a_click(
    client: httpx.Client, repository: Repository
) -> None:
    assert addresses(page(client.get(HERE)), UNDO) == []
    client.post(f"{HERE}/reference", data={"reason": "tested"})
    (note,) = notes(repository)
    (undo,) = addresses(page(client.get(HERE)), UNDO)
    assert undo == f"{HERE}/notes/{note.id}/undo"
    answer = client.post(undo)
    assert (answer.status_code, answer.headers["location"]) == (303, f"{HERE}/logbook?done=undone")
    assert notes(repository) == []


def test_a_note_that_was_retracted_by_mistake_is_kept_again(
    client: httpx.Client, repository: Repository
) -> None:
    client.post(f"{HERE}/notes", data={"text": "new bearing", "kind": "maintenance", "anew": "yes"})
    (note,) = notes(repository)
    client.post(f"{HERE}/notes/{note.id}/withdrawal", data={"reason": "wrong motor"})
    assert notes(repository) == []
    (undo,) = addresses(page(client.get(HERE)), UNDO)
    assert client.post(undo).status_code == 303
    (again,) = notes(repository)
    assert (again.kind, again.reason, again.time_ns) == (note.kind, note.reason, note.time_ns)


def test_a_note_that_changes_nothing_is_not_undone_by_a_click(
    client: httpx.Client, repository: Repository
) -> None:
    client.post(f"{HERE}/notes", data={"text": "only words"})
    (note,) = notes(repository)
    assert addresses(page(client.get(HERE)), UNDO) == [], "it changed nothing"
    assert client.post(f"{HERE}/notes/{note.id}/undo").status_code == 409


@pytest.mark.parametrize(
    ("note", "account", "after_ns", "may"),
    [
        (NOTE, "ann", 0, True),
        (NOTE, "ann", UNDO_NS, True),
        (NOTE, "ann", UNDO_NS + 1, False),
        (NOTE, "bob", 0, False),
        (replace(NOTE, kind=EventKind.NOTE), "ann", 0, False),
        (replace(NOTE, withdrawn_ns=NOW_NS, withdrawn_account="bob"), "bob", UNDO_NS, True),
        (replace(NOTE, withdrawn_ns=NOW_NS, withdrawn_account="bob"), "ann", 0, False),
    ],
)
def test_it_is_the_same_person_within_ten_minutes(
    note: ConditionEvent, account: str, after_ns: int, may: bool
) -> None:
    assert may_undo(note, account, NOW_NS + after_ns) == may
    assert latest_to_undo([note], account, NOW_NS + after_ns) == (note if may else None)


def test_the_api_undoes_the_same(client: httpx.Client, repository: Repository) -> None:
    client.post(f"{HERE}/reference", data={"reason": "tested"})
    (note,) = notes(repository)
    answer = client.post(f"/api/v1{HERE}/notes/{note.id}/undo")
    assert (answer.status_code, answer.json()["withdrawn_reason"]) == (200, "undone within 10 minutes")
    assert notes(repository) == []
    again = client.post(f"/api/v1{HERE}/notes/{note.id}/undo").json()
    assert (again["kind"], again["text"]) == ("reference-restarted", "tested")
    (kept,) = notes(repository)
    assert (kept.id, kept.time_ns) == (again["id"], note.time_ns)
