"""Entries of the audit trail on their way to a syslog server."""

import re
import socketserver
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from service.api import ApiContext, create_app
from service.audit.actions import AuditAction
from service.background.audit_forwarding import SENT_AT_ONCE, AuditForwarding
from service.configuration.audit import AuditSettings, AuditSyslog
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.ports import free_port
from testing.service.accounts import auditor
from testing.service.plants import NOW_NS
from testing.waiting import wait_until
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

HOSTILE = 'Eve\n<13>1 - - - "] forged'
TWO_DATABASES = pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)


class Received(socketserver.ThreadingTCPServer):
    """A syslog server over TCP that keeps the records of each connection."""

    allow_reuse_address = True

    def __init__(self, port: int = 0) -> None:
        self.connections: list[list[str]] = []
        super().__init__(("127.0.0.1", port), _Connection)

    @property
    def records(self) -> list[str]:
        return [record for connection in self.connections for record in connection]

    def numbers(self) -> list[int]:
        return [int(re.findall(r'number="(\d+)"', record)[0]) for record in self.records]


class _Connection(socketserver.StreamRequestHandler):
    def handle(self) -> None:
        assert isinstance(self.server, Received)
        records = []
        while length := self.rfile.read(1):
            while (digit := self.rfile.read(1)) != b" ":
                length += digit
            records.append(self.rfile.read(int(length)).decode())
        self.server.connections.append(records)


@contextmanager
def syslog_server(port: int = 0) -> Iterator[Received]:
    with Received(port) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


def note(repository: Repository, number: int, name: str = "anna") -> None:
    for index in range(number):
        actor, after = Actor(name, "10.0.0.7"), {"text": f"bearing {index}"}
        repository.note_by(actor, AuditAction.NOTE_ADDED, ("motor", "PUMP-A1"), now_ns=NOW_NS, after=after)


def forwarding(repository: Repository, port: int) -> AuditForwarding:
    return AuditForwarding(repository, AuditSyslog(host="127.0.0.1", port=port, transport="tcp", timeout_s=5))


@TWO_DATABASES
def test_every_entry_comes_once_and_in_order(repository: Repository) -> None:
    note(repository, SENT_AT_ONCE + 5)
    with syslog_server() as server:
        to_it = forwarding(repository, server.server_address[1])
        to_it.forward()
        note(repository, 2, HOSTILE)
        to_it.forward()
        to_it.forward()  # there is nothing left
        wait_until(lambda: len(server.records) == SENT_AT_ONCE + 7, "all records")
    assert sorted(map(len, server.connections)) == [2, 5, SENT_AT_ONCE]
    assert sorted(server.numbers()) == list(range(1, SENT_AT_ONCE + 8))
    entries = repository.audit_entries(limit=1).items
    record = next(record for record in server.records if f'number="{entries[0].number}"' in record)
    assert record.startswith("<109>1 "), "facility 13 (audit), severity 5 (notice)"
    assert f'hash="{entries[0].hash}"' in record
    assert "note-added, motor PUMP-A1" in record
    assert "\n" not in record
    assert r"Eve <13>1 - - - \"\] forged" in record


def test_entries_wait_for_a_server_that_does_not_answer(repository: Repository) -> None:
    port = free_port()
    to_it = forwarding(repository, port)
    note(repository, 2)
    to_it.forward()
    assert repository.forwarded_audit_entry() == 0
    note(repository, 1)
    with syslog_server(port) as server:
        to_it.forward()
        wait_until(lambda: len(server.records) == 3, "what waited")
    assert server.numbers() == [1, 2, 3]
    assert repository.forwarded_audit_entry() == 3


def test_two_services_go_on_where_the_first_has_come_to(repository: Repository) -> None:
    note(repository, 3)
    repository.note_forwarded_audit_entries(0, 3)
    repository.note_forwarded_audit_entries(0, 2)  # of the one that was slower
    assert repository.forwarded_audit_entry() == 3


def test_the_api_says_how_far_it_is(repository: Repository, store: RecordingStore, tmp_path: Path) -> None:
    note(repository, 2)
    repository.note_forwarded_audit_entries(0, 1)
    for audit, told in ((AuditSettings(), None), (AuditSettings(syslog=AuditSyslog(host="log")), 1)):
        settings = Settings(data_directory=tmp_path, audit=audit)
        with serving(create_app(ApiContext(settings, repository, store))) as client:
            client.headers.update(auditor(repository))
            assert client.get("/api/v1/audit/head").json()["forwarded"] == told


def test_the_settings_take_a_table_of_a_server(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('[audit.syslog]\nhost = "log.plant.example"\nca = "ca.pem"\n')
    syslog = Settings.load(config).audit.syslog
    assert syslog is not None
    assert (syslog.transport, syslog.server_port, syslog.facility) == ("tls", 6514, "audit")
    assert syslog.ca == tmp_path / "ca.pem"
