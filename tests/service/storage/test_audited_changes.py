"""Every change that somebody asks for leaves an entry in the transaction that makes it."""

import json
from dataclasses import replace

import pytest

from core.condition.events import Event, EventKind
from service.audit.entries import AuditEntry
from service.audit.verification import verify
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository, StateConflictError
from service.storage.records import Actor, RecordingEntry, Role
from service.timing.backoff import Backoff
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, healthy, two_motor_plant

ANNA = Actor("anna", "10.0.0.7", frozenset({Role.ENGINEER}))
MOTOR = "PUMP-A1"


def entries(repository: Repository) -> list[AuditEntry]:
    """All entries, the first one first; they have to be a chain."""
    with repository.audit_trail() as trail:
        assert verify(trail.entries, head=trail.head).fault is None
        return list(trail.entries())


def told(entry: AuditEntry) -> tuple[str, str, str, object, object]:
    assert (entry.actor, entry.origin, entry.roles) == ("anna", "10.0.0.7", "ENGINEER")
    assert entry.time_ns == NOW_NS
    before, after = (None if text is None else json.loads(text) for text in (entry.before, entry.after))
    return entry.action, entry.subject_kind, entry.subject, before, after


def uploaded(repository: Repository, store: RecordingStore, content: bytes = b"samples") -> RecordingEntry:
    stored = store.store({"EVENT.CFG": b"config", "EVENT.DAT": content})
    return repository.add_recording(stored, motor=MOTOR, by=ANNA, now_ns=NOW_NS).recording


def test_a_recording_request(repository: Repository) -> None:
    request = repository.request_recording(MOTOR, by=ANNA, now_ns=NOW_NS, idempotency_key="a")
    assert repository.request_recording(MOTOR, by=ANNA, now_ns=NOW_NS, idempotency_key="a") == request
    with pytest.raises(NotFoundError):
        repository.request_recording("PUMP-A9", by=ANNA, now_ns=NOW_NS)
    (entry,) = entries(repository)
    after = {"request": request.id, "relay": "A1_SEL710"}
    assert told(entry) == ("recording-requested", "motor", MOTOR, None, after)


def test_what_the_service_does_by_schedule_leaves_none(repository: Repository) -> None:
    repository.schedule_recording(MOTOR, due_ns=NOW_NS, now_ns=NOW_NS)
    assert entries(repository) == []


def test_an_upload_and_its_deletion(repository: Repository, store: RecordingStore) -> None:
    recording = uploaded(repository, store)
    uploaded(repository, store)  # the same again is no change
    repository.delete_recording(recording.id, "a test", by=ANNA, now_ns=NOW_NS)
    upload, deletion = entries(repository)
    content = {"motor": MOTOR, "name": recording.name, "digest": recording.digest}
    assert told(upload) == (
        "recording-uploaded", "recording", recording.id, None, {**content, "size_bytes": recording.size_bytes}
    )  # fmt: skip
    assert told(deletion) == (
        "recording-deleted",
        "recording",
        recording.id,
        {**content, "state": "fetched", "verdict": None},
        {"reason": "a test"},
    )


def test_another_diagnosis(repository: Repository, store: RecordingStore) -> None:
    recording = uploaded(repository, store)
    job = repository.request_diagnosis(recording.id, by=ANNA, now_ns=NOW_NS, method="genetic")
    entry = entries(repository)[-1]
    assert told(entry) == (
        "diagnosis-requested",
        "recording",
        recording.id,
        None,
        {"diagnosis": job.id, "motor": MOTOR, "method": "genetic", "model": job.model},
    )


def test_a_baseline_chosen_replaced_and_dropped(repository: Repository, store: RecordingStore) -> None:
    recordings = [uploaded(repository, store, bytes([number])).id for number in range(4)]
    for _ in recordings:
        claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id, findings_of(healthy()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
        )
        repository.leave_out(claimed.job.recording_id, "told nothing", "test")
    first, second = sorted(recordings[:3]), sorted(recordings[1:])
    repository.set_baseline(
        MOTOR, first, by=ANNA, reason="new winding", on_behalf_of="B. Moore", now_ns=NOW_NS
    )
    repository.set_baseline(MOTOR, second, by=ANNA, now_ns=NOW_NS)
    repository.delete_baseline(MOTOR, by=ANNA, now_ns=NOW_NS)
    repository.delete_baseline(MOTOR, by=ANNA, now_ns=NOW_NS)  # there is none any more
    chosen, replaced, dropped = (told(entry) for entry in entries(repository)[-3:])
    assert [one[:3] for one in (chosen, replaced, dropped)] == [
        ("baseline-set", "motor", MOTOR),
        ("baseline-set", "motor", MOTOR),
        ("baseline-deleted", "motor", MOTOR),
    ]
    assert chosen[3] is None
    assert chosen[4] == {"recordings": first, "reason": "new winding", "on_behalf_of": "B. Moore"}
    assert replaced[3] == chosen[4]
    assert replaced[4] == {"recordings": second, "reason": None, "on_behalf_of": None}
    assert dropped[3:] == (replaced[4], {"reason": None, "on_behalf_of": None})


def test_notes_and_references(repository: Repository) -> None:
    event = Event(NOW_NS, EventKind.MAINTENANCE, "cleaned")
    note = repository.add_event(MOTOR, event, by=ANNA, now_ns=NOW_NS)
    repository.withdraw_event(
        MOTOR, note.id, by=ANNA, on_behalf_of="B. Moore", reason="not this one", now_ns=NOW_NS
    )
    with pytest.raises(StateConflictError):
        repository.withdraw_event(MOTOR, note.id, by=ANNA, reason="again", now_ns=NOW_NS)
    restart = Event(NOW_NS, EventKind.REFERENCE_RESTARTED, "tested")
    repository.add_event(MOTOR, restart, by=ANNA, on_behalf_of="B. Moore", now_ns=NOW_NS)
    added, withdrawn, restarted = (told(entry) for entry in entries(repository))
    assert added[0] == "note-added"
    assert isinstance(added[4], dict)
    assert (added[4]["note"], added[4]["text"], added[4]["on_behalf_of"]) == (note.id, "cleaned", None)
    assert withdrawn[0] == "note-withdrawn"
    assert withdrawn[3:] == (added[4], {"reason": "not this one", "on_behalf_of": "B. Moore"})
    assert restarted[0] == "reference-restarted"


def test_a_quarantine_released(repository: Repository) -> None:
    repository.set_aside("A1_SEL710", "crashed", backoff=Backoff(60.0, 60.0), now_ns=NOW_NS)
    repository.release("A1_SEL710", by=ANNA, now_ns=NOW_NS)
    repository.release("A1_SEL710", by=ANNA, now_ns=NOW_NS)  # harmless, and no change
    (entry,) = entries(repository)
    action, kind, subject, before, _ = told(entry)
    assert (action, kind, subject) == ("quarantine-released", "relay", "A1_SEL710")
    assert isinstance(before, dict)
    assert (before["reason"], before["times"]) == ("crashed", 1)


def test_the_plant_at_a_start(repository: Repository) -> None:
    plant = two_motor_plant()
    repository.sync_plant(plant, noted_ns=NOW_NS)
    assert entries(repository) == [], "nothing differs from what the fixture said"
    pump, fan = plant.motors
    moved = replace(plant, motors=(replace(pump, description="booster pump"),))
    repository.sync_plant(moved, noted_ns=NOW_NS)
    repository.sync_plant(plant, noted_ns=NOW_NS)
    left, changed, came, back = entries(repository)
    assert {(entry.actor, entry.origin, entry.action) for entry in (left, changed, came, back)} == {
        ("statorwatch", "service", "plant-changed")
    }
    assert left.subject == came.subject == fan.name
    assert json.loads(left.before or "")["site"] == fan.site
    assert left.after is None
    assert (came.before, came.after) == (None, left.before)
    assert (changed.subject, back.subject) == (pump.name, pump.name)
    assert json.loads(changed.before or "") == {"description": pump.description}
    assert json.loads(changed.after or "") == {"description": "booster pump"}


def test_figures_of_a_motor_at_a_start(repository: Repository) -> None:
    document = {
        "nameplate": {"rated_power_W": 1000},
        "parameters": {"stator_resistance_ohm": 1.5},
        "tolerances": {"source": "given"},
        "limits": {"fault_level": 0.005},
        "sensors": {},
    }
    repository.note_motors({MOTOR: document}, now_ns=NOW_NS)
    repository.note_motors({MOTOR: document}, now_ns=NOW_NS)
    assert entries(repository) == []
    edited = {**document, "limits": {"fault_level": 0.01}, "parameters": {"stator_resistance_ohm": 1.6}}
    repository.note_motors({MOTOR: edited}, now_ns=NOW_NS)
    (entry,) = entries(repository)
    assert (entry.action, entry.subject) == ("parameters-changed", MOTOR)
    assert json.loads(entry.before or "") == {
        "parameters.stator_resistance_ohm": 1.5,
        "limits.fault_level": 0.005,
    }
    assert json.loads(entry.after or "") == {
        "parameters.stator_resistance_ohm": 1.6,
        "limits.fault_level": 0.01,
    }
