"""Entries of the audit trail in both databases: chained whoever writes, and never changed."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import Engine, text
from sqlalchemy.exc import DatabaseError

from service.audit.actions import AuditAction
from service.audit.entries import NO_HASH, Anchor
from service.audit.verification import Fault, Verification, verify
from service.roles import Role
from service.storage import Repository
from service.storage.records.actors import Actor
from testing.service.plants import NOW_NS

ANNA = Actor("anna", "10.0.0.7", frozenset({Role.OPERATOR, Role.ENGINEER}))


def note(repository: Repository, subject: str = "PUMP-A1", **after: object) -> None:
    repository.note_by(ANNA, AuditAction.NOTE_ADDED, ("motor", subject), now_ns=NOW_NS, after=after)


def verification(repository: Repository) -> Verification:
    with repository.audit_trail() as trail:
        return verify(trail.entries, head=trail.head)


def test_an_entry_says_who_did_what_from_where(repository: Repository) -> None:
    note(repository, text="bearing changed")
    (entry,) = repository.audit_entries(limit=10).items
    assert (entry.number, entry.time_ns, entry.previous) == (1, NOW_NS, NO_HASH)
    assert (entry.actor, entry.origin, entry.roles) == ("anna", "10.0.0.7", "ENGINEER OPERATOR")
    assert (entry.action, entry.subject_kind, entry.subject) == ("note-added", "motor", "PUMP-A1")
    assert (entry.before, entry.after) == (None, '{"text":"bearing changed"}')
    assert verification(repository) == Verification(1, Anchor(1, entry.hash))


def test_secrets_are_not_kept(repository: Repository) -> None:
    note(repository, API_TOKEN=None, **{"new password": "x"}, account={"token_hash": "x", "note": "blue"})
    (entry,) = repository.audit_entries(limit=10).items
    assert entry.after == (
        '{"API_TOKEN":null,"account":{"note":"blue","token_hash":"(not kept)"},"new password":"(not kept)"}'
    )


def test_hostile_texts_are_kept_as_far_as_a_database_can(repository: Repository) -> None:
    hostile = 'a\0b\ud800"\n<script>\u2028é' + "x" * 10_000
    note(repository, hostile, text=hostile, number=float("nan"))
    (entry,) = repository.audit_entries(limit=10).items
    assert entry.subject.startswith('a\ufffdb\ufffd"\n<script>\u2028éx')
    assert len(entry.subject) < 5000
    assert verification(repository).fault is None


def test_writers_at_once_make_one_chain(repository: Repository, engine: Engine) -> None:
    """Each has connections of its own, as several services on one database have."""
    writers = [Repository(engine) for _ in range(4)]

    def write(writer: Repository) -> None:
        for number in range(10):
            note(writer, number=number)

    with ThreadPoolExecutor(len(writers)) as pool:
        for future in [pool.submit(write, writer) for writer in writers]:
            future.result(timeout=60)
    found = verification(repository)
    assert (found.fault, found.entries) == (None, 40)


CHANGES = [
    "UPDATE audit_entries SET actor = 'mallory' WHERE number = 2",
    "UPDATE audit_entries SET number = 9 WHERE number = 2",
    "DELETE FROM audit_entries WHERE number = 3",
    "DELETE FROM audit_entries",
    "UPDATE audit_head SET number = 2",
    "UPDATE audit_head SET hash = previous.hash FROM audit_entries AS previous WHERE previous.number = 2",
    "DELETE FROM audit_head",
    "INSERT INTO audit_head VALUES (2, 0, '')",
]
REPLACING = "INSERT OR REPLACE INTO {table} SELECT {columns} FROM {table} LIMIT 1"


@pytest.mark.parametrize("statement", CHANGES)
def test_the_database_refuses_to_change_an_entry(
    repository: Repository, engine: Engine, statement: str
) -> None:
    for number in range(3):
        note(repository, number=number)
    before = repository.audit_entries(limit=10)
    with pytest.raises(DatabaseError, match="audit"), engine.begin() as connection:
        connection.execute(text(statement))
    assert repository.audit_entries(limit=10) == before
    assert verification(repository).fault is None


@pytest.mark.parametrize("table", ["audit_entries", "audit_head"])
def test_the_database_refuses_to_replace_or_empty_a_table(
    repository: Repository, engine: Engine, table: str
) -> None:
    note(repository)
    statement = f"TRUNCATE {table}"
    if engine.dialect.name == "sqlite":
        statement = f"INSERT OR REPLACE INTO {table} SELECT * FROM {table} LIMIT 1"  # noqa: S608 - names of the test
    with pytest.raises(DatabaseError, match="audit trail"), engine.begin() as connection:
        connection.execute(text(statement))
    assert verification(repository).entries == 1


def without_triggers(engine: Engine, statement: str) -> None:
    """Change the table as its owner can, who drops the triggers first."""
    with engine.begin() as connection:
        if engine.dialect.name == "sqlite":
            for event in ("update", "delete", "insert"):
                connection.execute(text(f"DROP TRIGGER audit_entries_{event}"))
        else:
            connection.execute(text("ALTER TABLE audit_entries DISABLE TRIGGER ALL"))
        connection.execute(text(statement))


@pytest.mark.parametrize(
    ("statement", "fault", "number"),
    [
        (CHANGES[0], Fault.CHANGED, 2),
        (CHANGES[1], Fault.REMOVED, 2),
        (CHANGES[2], Fault.REMOVED, 3),
        (CHANGES[3], Fault.CUT_OFF, 1),
        ("DELETE FROM audit_entries WHERE number > 3", Fault.CUT_OFF, 4),
    ],
)
def test_what_is_changed_in_spite_of_the_triggers_is_found(
    repository: Repository, engine: Engine, statement: str, fault: Fault, number: int
) -> None:
    for _ in range(5):
        note(repository)
    without_triggers(engine, statement)
    found = verification(repository)
    assert (found.fault, found.number) == (fault, number)


def test_a_trail_is_read_as_it_was_when_reading_began(repository: Repository) -> None:
    for _ in range(3):
        note(repository)
    with repository.audit_trail() as trail:
        note(repository)
        assert verify(trail.entries, head=trail.head).entries == 3
        assert [entry.number for entry in trail.entries(first=2)] == [2, 3]
    assert verification(repository).entries == 4


def test_pages_narrow_and_go_on(repository: Repository) -> None:
    for number in range(5):
        note(repository, "PUMP-A1" if number % 2 else "FAN-A2")
    page = repository.audit_entries(limit=2)
    assert [entry.number for entry in page.items] == [5, 4]
    page = repository.audit_entries(limit=10, after=page.next)
    assert [entry.number for entry in page.items] == [3, 2, 1]
    assert [entry.number for entry in repository.audit_entries(limit=9, subject="PUMP-A1").items] == [4, 2]
    assert repository.audit_entries(limit=9, actor="bert").items == ()
    assert len(repository.audit_entries(limit=9, actor="anna", action=AuditAction.NOTE_ADDED).items) == 5
    assert repository.audit_entries(limit=9, from_ns=NOW_NS + 1).items == ()
    assert repository.audit_entries(limit=9, to_ns=NOW_NS).items == ()


def test_a_change_that_is_taken_back_leaves_no_entry(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    note(repository)
    with pytest.raises(DatabaseError), repository._write() as session:
        session.execute(text("INSERT INTO no_such_table VALUES (1)"))
    assert verification(repository).entries == 1
