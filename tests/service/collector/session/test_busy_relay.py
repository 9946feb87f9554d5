"""A relay that answers that it cannot serve a request for now keeps to the protocol, and is waited for."""

from dataclasses import replace

import pytest

from mms import Client, FunctionalConstraint, ServiceFailed, TemporarilyUnavailable
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.storage.states import LinkState, RecordingRequestState
from service.timing.backoff import Backoff
from testing.ports import LOOPBACK
from testing.waiting import eventually
from tests.service.collector.busy_front import FILE_DIRECTORY, LIST_OF_NAMES, READ, busy_front
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import FAULT_NUMBER, NAME, ScriptedRelay

QUICK = SessionPolicy(reconnect=Backoff(first_s=0.01, longest_s=0.02))
MANY = 4 * SESSION_POLICY.faults_in_a_row


@pytest.mark.parametrize(("service", "times"), [(LIST_OF_NAMES, 4), (READ, MANY), (FILE_DIRECTORY, MANY)])
def test_a_relay_that_is_busy_is_not_set_aside(
    bench: Bench, relay: ScriptedRelay, service: bytes, times: int
) -> None:
    """Each of these refusals ended a visit once, and five visits set the relay aside."""
    relay.write_record("HR_10001", report=False)
    bench.policy = replace(QUICK, records=bench.policy.records)
    with busy_front(bench.relay.port, {service: times}) as front:
        bench.relay = replace(bench.relay, port=front.port)
        bench.with_settings(poll_period_s=0.02)
        with bench.session():
            assert eventually(lambda: front.refused[service] == 0 and bench.is_stored("HR_10001"), 20)
            assert bench.link() is LinkState.UP
    assert bench.repository.quarantine(NAME) is None


def test_a_trigger_waits_until_the_files_can_be_listed(bench: Bench, relay: ScriptedRelay) -> None:
    """Records that were there before, and could not be seen, are not the trigger's."""
    relay.write_record("HR_1", report=False)
    with busy_front(bench.relay.port, {FILE_DIRECTORY: 3}) as front:
        bench.relay = replace(bench.relay, port=front.port)
        request = bench.request()
        with bench.session():
            assert bench.reaches(request, RecordingRequestState.FETCHED)
    recording = bench.recording("HR_10001")
    assert recording is not None
    assert recording.id == bench.requested(request).recording_id


def test_a_request_to_a_relay_that_lists_nothing_ends_with_the_reason(
    bench: Bench, relay: ScriptedRelay
) -> None:
    with busy_front(bench.relay.port, {FILE_DIRECTORY: 1_000_000}) as front:
        bench.relay = replace(bench.relay, port=front.port)
        request = bench.request()
        with bench.session():
            assert bench.reaches(request, RecordingRequestState.FAILED)
    assert "lists no files for now" in (bench.requested(request).reason or "")
    assert relay.edges == 0


def test_a_service_error_is_told_from_a_reject(relay: ScriptedRelay) -> None:
    """The library's own client functions give one number, 99, for both."""
    with busy_front(relay.port, {}) as front, Client.connect(LOOPBACK, front.port) as client:
        front.refused[READ] = 1
        with pytest.raises(TemporarilyUnavailable, match="resources are used up"):
            client.read(f"{FAULT_NUMBER}.stVal", FunctionalConstraint.ST)
        front.error = (0x84, 0)
        front.refused[READ] = 1
        with pytest.raises(ServiceFailed, match="MMS error 50"):
            client.read(f"{FAULT_NUMBER}.stVal", FunctionalConstraint.ST)
        assert client.read(f"{FAULT_NUMBER}.stVal", FunctionalConstraint.ST) == 0


def test_a_device_that_cannot_be_listed_leaves_the_others(relay: ScriptedRelay) -> None:
    with busy_front(relay.port, {}) as front, Client.connect(LOOPBACK, front.port) as client:
        first, second, *_ = client.logical_devices()
        front.refused[LIST_OF_NAMES] = 1
        with pytest.raises(TemporarilyUnavailable):
            client.logical_nodes(first)
        assert client.logical_nodes(second)
        assert client.logical_nodes(first), "it was asked again"
