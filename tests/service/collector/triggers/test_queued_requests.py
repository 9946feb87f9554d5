"""Recording requests that queue up at a relay: the next follows at once, and until then it is not hurried."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

import pytest

from service.collector.gateway.gateway import Gateway, GatewayIdentity
from service.plant import Plant, PlantMotor, Site
from service.storage.states import LinkState, RecordingRequestState
from testing.service.plants import SECOND_NS, motor
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

LONG_S = 60.0
WATCHED_S = 2.0
AT_ONCE_S = 1.5


@contextmanager
def gateway(bench: Bench) -> Iterator[None]:
    """A gateway on a thread that visits the bench's relay."""
    made = Gateway(
        GatewayIdentity("a", "here", os.getpid()),
        Plant(
            sites=(Site("FACTORY_A", "Factory A"),),
            relays=(bench.relay,),
            motors=(PlantMotor(motor(MOTOR), "pump", "FACTORY_A", NAME),),
        ),
        bench.repository,
        bench.store,
        bench.settings,
        on_expiry=lambda: None,
    )
    stop = Event()
    thread = Thread(target=made.run, args=(stop,))
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join(15)
        assert not thread.is_alive()


@pytest.fixture
def silent(relay: ScriptedRelay) -> ScriptedRelay:
    """It makes its records when the test says so."""
    relay.silent = True
    return relay


def test_a_queue_does_not_hurry_the_listings(bench: Bench, silent: ScriptedRelay) -> None:
    with gateway(bench.with_settings(poll_period_s=LONG_S, record_timeout_s=LONG_S)):
        assert eventually(lambda: bench.link() is LinkState.UP)
        first, second, _ = (bench.request() for _ in range(3))
        assert bench.reaches(first, RecordingRequestState.TRIGGERED)
        assert not eventually(lambda: silent.edges > 1, within_s=0.5)
        before = silent.listings
        assert not eventually(lambda: silent.listings > before, within_s=WATCHED_S)
        assert bench.requested(second).state is RecordingRequestState.REQUESTED
        silent.write_record("HR_1")
        assert bench.reaches(first, RecordingRequestState.FETCHED)
        assert bench.reaches(second, RecordingRequestState.TRIGGERED)
    ended, granted = bench.requested(first).fetched_ns, bench.requested(second).triggered_ns
    assert ended is not None
    assert granted is not None
    assert granted - ended < 0.1 * LONG_S * SECOND_NS, "not only when the relay is polled"


def test_the_next_follows_at_once_where_no_record_came(bench: Bench, silent: ScriptedRelay) -> None:
    poll_period_s = 2 * AT_ONCE_S
    with gateway(bench.with_settings(poll_period_s=poll_period_s, record_timeout_s=1.0)):
        assert eventually(lambda: bench.link() is LinkState.UP)
        first, second = bench.request(), bench.request()
        assert bench.reaches(first, RecordingRequestState.FAILED)
        assert bench.reaches(second, RecordingRequestState.TRIGGERED)
    failed, granted = bench.requested(first).failed_ns, bench.requested(second).triggered_ns
    assert failed is not None
    assert granted is not None
    assert granted - failed < AT_ONCE_S * SECOND_NS


def test_a_record_under_a_name_that_was_listed_before_belongs_to_its_request(
    bench: Bench, silent: ScriptedRelay
) -> None:
    """A relay whose numbers began anew writes it over the old one."""
    silent.write_record("HR_1", b"an old record")
    with bench.with_settings(record_timeout_s=LONG_S).session() as session:
        assert eventually(lambda: bench.is_stored("HR_1"))
        old = bench.recording("HR_1")
        request_id = bench.request()
        session.wake()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        silent.write_record("HR_1", b"the record that was asked for")
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    recording = bench.repository.recording(bench.requested(request_id).recording_id or "")
    assert old is not None
    assert recording.id != old.id
    stored = bench.store.directory(recording.digest or "") / "HR_1.DAT"
    assert stored.read_bytes() == b"the record that was asked for"


def test_a_record_that_could_not_be_fetched_before_the_trigger_belongs_to_no_request(
    bench: Bench, silent: ScriptedRelay
) -> None:
    """It may be written on meanwhile, and be listed with another size."""
    silent.denied.add("HR_1")
    silent.write_record("HR_1", b"an old record")
    with bench.session() as session:
        request_id = bench.request()
        session.wake()
        assert bench.reaches(request_id, RecordingRequestState.TRIGGERED)
        silent.denied.clear()
        silent.write_record("HR_1", b"an old record, and more of it")
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    assert bench.requested(request_id).recording_id is None
