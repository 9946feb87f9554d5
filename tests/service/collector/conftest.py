"""A plant of one scripted relay, a real database and recording store, and sessions to run against them."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Thread

import pytest

from core.machines.parameters import Motor
from service.collector.records.policy import RecordPolicy
from service.collector.session.notes import Notes
from service.collector.session.relay_session import RelaySession
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.configuration.settings import Settings
from service.plant import Plant, PlantMotor, Relay, Site
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import RecordingEntry, RecordingRequest, Sample
from service.storage.states import AlarmKind, LinkState, RecordingRequestState, RecordingState
from testing.ports import LOOPBACK, free_port
from testing.service.database import make_database
from testing.service.plants import motor
from testing.waiting import eventually
from tests.service.collector.scripted_relay import (
    CONTROL,
    FAULT_NUMBER,
    NAME,
    RECORD_MADE,
    REPORT_CONTROL,
    ScriptedRelay,
)

MOTOR = "PUMP-A1"


@dataclass
class Bench:
    """The service's side of one relay.

    kept_in: where sessions keep recordings, in the place of `store`.
    notes: takes what sessions note, which is written at once where there is none.
    """

    relay: Relay
    repository: Repository
    store: FolderStore
    settings: Settings
    relay_root: Path
    policy: SessionPolicy = SESSION_POLICY
    reported: Motor | None = None
    kept_in: RecordingStore | None = None
    notes: Notes | None = None

    def start_relay(self) -> ScriptedRelay:
        return ScriptedRelay(self.relay_root, self.relay.port)

    @contextmanager
    def session(self, on_sample: Callable[[Sample], None] | None = None) -> Iterator[RelaySession]:
        """A running session; the block's end is the collector's end."""
        session = RelaySession(
            self.relay,
            MOTOR,
            self.repository,
            self.kept_in or self.store,
            self.settings,
            on_sample=on_sample,
            notes=self.notes,
            reported=self.reported,
            policy=self.policy,
        )
        thread = Thread(target=session.run)
        thread.start()
        try:
            yield session
        finally:
            session.stop()
            thread.join(15)
            assert not thread.is_alive()

    def request(self) -> str:
        return self.repository.request_recording(MOTOR, now_ns=time.time_ns()).id

    def requested(self, request_id: str) -> RecordingRequest:
        return self.repository.recording_request(request_id)

    def reaches(self, request_id: str, state: RecordingRequestState) -> bool:
        return eventually(lambda: self.requested(request_id).state is state)

    def recordings(self) -> list[RecordingEntry]:
        return list(self.repository.recordings(limit=100).items)

    def recording(self, name: str) -> RecordingEntry | None:
        """The latest recording of this name."""
        return next((recording for recording in self.recordings() if recording.name == name), None)

    def is_stored(self, name: str) -> bool:
        recording = self.recording(name)
        return recording is not None and recording.state is RecordingState.FETCHED

    def alarms(self) -> dict[AlarmKind, list[str]]:
        """Subjects of the alarms that stand, by kind."""
        standing: dict[AlarmKind, list[str]] = {}
        for alarm in self.repository.standing_alarms(NAME):
            standing.setdefault(alarm.kind, []).append(alarm.subject)
        return standing

    def with_settings(self, **changes: object) -> "Bench":
        self.settings = self.settings.model_copy(update=changes)
        return self

    def with_record_policy(self, policy: RecordPolicy) -> "Bench":
        self.policy = replace(self.policy, records=policy)
        return self

    def link(self) -> LinkState:
        return self.repository.relay(NAME).link_state


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    settings = Settings(
        data_directory=tmp_path / "data",
        record_timeout_s=2.0,
        poll_period_s=0.3,
        connect_timeout_s=2.0,
        request_timeout_s=2.0,
        max_file_bytes=100_000,
    )
    settings.data_directory.mkdir()
    make_database(settings.data_directory)
    relay = Relay(
        name=NAME,
        site="FACTORY_A",
        host=LOOPBACK,
        port=free_port(),
        manufacturer="SEL",
        type="SEL-710",
        trigger_control=CONTROL,
        record_made=RECORD_MADE,
        fault_number=FAULT_NUMBER,
        report_control=REPORT_CONTROL,
        metering_data_set=None,
    )
    plant = Plant(
        sites=(Site("FACTORY_A", "Factory A"),),
        relays=(relay,),
        motors=(PlantMotor(motor(MOTOR), "pump", "FACTORY_A", NAME),),
    )
    repository = Repository(connect(settings.database_url))
    repository.sync_plant(plant)
    store = FolderStore(settings.recordings_directory)
    return Bench(relay, repository, store, settings, tmp_path / "relay")


@pytest.fixture
def relay(bench: Bench) -> Iterator[ScriptedRelay]:
    scripted = bench.start_relay()
    yield scripted
    scripted.stop()
