"""A relay that answers that it cannot serve a request for now keeps to the protocol, and is waited for."""

from dataclasses import replace

import pytest

import scl
from mms import Client, FunctionalConstraint, ServiceFailed, TemporarilyUnavailable
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.plant.offer import offer_from_scl
from service.storage.states import AlarmKind, LinkState, RecordingRequestState
from service.timing.backoff import Backoff
from testing.ports import LOOPBACK
from testing.waiting import eventually
from tests.service.collector.busy_front import (
    DATA_SET_MEMBERS,
    FILE_DIRECTORY,
    LIST_OF_NAMES,
    READ,
    VARIABLE_DESCRIPTION,
    WRITE,
    busy_front,
)
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import CONTROL, FAULT_NUMBER, NAME, ScriptedRelay

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


def test_files_that_are_never_listed_show_at_the_relay(bench: Bench, relay: ScriptedRelay) -> None:
    """Nobody need ask for a recording to be told."""
    with busy_front(bench.relay.port, {FILE_DIRECTORY: 1_000_000}) as front:
        bench.relay = replace(bench.relay, port=front.port)
        bench.with_settings(poll_period_s=0.05, record_timeout_s=0.5)
        with bench.session():
            assert eventually(lambda: bench.alarms() == {AlarmKind.FILE_UNSTEADY: [""]})
            assert "no recording is fetched for now" in (bench.repository.relay(NAME).link_reason or "")
            front.refused.clear()
            assert eventually(lambda: bench.alarms() == {})
            assert eventually(lambda: bench.repository.relay(NAME).link_reason is None)


@pytest.mark.parametrize("service", [DATA_SET_MEMBERS, READ])
def test_what_a_busy_relay_does_not_tell_is_taken_from_its_scl(
    bench: Bench, relay: ScriptedRelay, service: bytes
) -> None:
    ied = scl.read(scl.DEMO_PLANT_SCD).ied(NAME)
    with busy_front(bench.relay.port, {service: 60}) as front:
        bench.relay = replace(bench.relay, port=front.port, expected=offer_from_scl(ied))
        bench.policy = replace(QUICK, report_retry_s=0.05)
        bench.with_settings(poll_period_s=0.05)
        with bench.session():
            assert eventually(lambda: bench.link() is LinkState.UP)
            assert front.refused.pop(service) < 60
            assert bench.alarms() == {}
            relay.write_record("HR_10001")
            assert eventually(lambda: bench.is_stored("HR_10001"))
            found = bench.repository.relay_findings(NAME)
            assert found is not None
            assert found.acquisition["records_told_by"] == "buffered-report"


@pytest.mark.parametrize("service", [READ, VARIABLE_DESCRIPTION])
def test_a_control_is_described_when_the_relay_has_time(relay: ScriptedRelay, service: bytes) -> None:
    with busy_front(relay.port, {}) as front, Client.connect(LOOPBACK, front.port) as client:
        front.refused[service] = 2
        client.operate(CONTROL, value=True)
        assert relay.edges == 1
        front.refused[service] = 1_000
        with pytest.raises(TemporarilyUnavailable, match="resources are used up"):
            client.operate(CONTROL, value=False)


def test_a_command_that_is_answered_by_a_service_error_is_no_timeout(relay: ScriptedRelay) -> None:
    with busy_front(relay.port, {WRITE: 1}) as front, Client.connect(LOOPBACK, front.port) as client:
        with pytest.raises(ServiceFailed, match="service error to operate: it may be busy"):
            client.operate(CONTROL, value=True)
        client.operate(CONTROL, value=True)
        assert relay.edges == 1


def test_a_trigger_waits_until_the_relay_tells_of_its_control(bench: Bench, relay: ScriptedRelay) -> None:
    with busy_front(bench.relay.port, {}) as front:
        bench.relay = replace(bench.relay, port=front.port)
        bench.with_settings(metering_period_s=0.0)
        with bench.session() as session:
            assert eventually(lambda: bench.link() is LinkState.UP)
            front.refused[READ] = 6
            request = bench.request()
            session.wake()
            assert bench.reaches(request, RecordingRequestState.FETCHED)
    assert relay.edges == 1


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
