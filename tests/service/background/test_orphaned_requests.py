"""A request whose relay no gateway visits fails with the reason; the others are left to their gateway."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from service.background.orphaned_requests import TRIGGERED_LIMIT_S, OrphanedRequestEnder
from service.collector.supervision.gateway_processes import GatewayProcesses
from service.configuration.settings import Settings
from service.plant import Plant
from service.storage import Repository
from service.storage.records import RecordingRequest
from service.storage.states import RecordingRequestState
from service.timing.backoff import Backoff
from testing.service.plants import NOW_NS, two_motor_plant
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

MOTOR, RELAY, OTHER = "PUMP-A1", "A1_SEL710", "A2_SEL710"
RECORD_S, LEASE_S = 20.0, 10.0
RESTART_S = 30.0
LIMIT_S = RECORD_S + LEASE_S + RESTART_S
STEP_S = 2.0


class Watch:
    """An ender of orphaned requests, with a monotonic clock that the tests set."""

    def __init__(self, repository: Repository, directory: Path) -> None:
        self.repository = repository
        self.problem: str | None = None
        settings = Settings(data_directory=directory, record_timeout_s=RECORD_S, lease_s=LEASE_S)
        self.ender = OrphanedRequestEnder(
            settings, repository, gateway_problem=lambda: self.problem, restart_delay_s=RESTART_S
        )
        self.now_s = 1000.0
        self.beating: list[str] = []

    def passes(self, seconds: float, *, step_s: float = STEP_S) -> None:
        for _ in range(round(seconds / step_s)):
            self.now_s += step_s
            for gateway in self.beating:
                self.repository.share_relays(gateway, [], most=0, problem=None)
            self.ender.end_overdue(self.now_s)

    @contextmanager
    def gateway(self, *relays: str) -> Iterator[None]:
        """One that holds these and goes on beating."""
        self.takes(*relays)
        self.beating.append("g")
        yield
        self.beating.remove("g")
        self.repository.end_gateway("g", now_ns=NOW_NS)

    def takes(self, *relays: str) -> None:
        self.repository.register_gateway("g", host="here", process_id=1, now_ns=NOW_NS)
        self.repository.share_relays("g", relays, most=10, problem=None)

    def ask(self) -> str:
        report = self.repository.request_recording(MOTOR, now_ns=NOW_NS).id
        self.ender.end_overdue(self.now_s)
        return report

    def report(self, report_id: str) -> RecordingRequest:
        return self.repository.recording_request(report_id)

    def state(self, report_id: str) -> RecordingRequestState:
        return self.report(report_id).state


@pytest.fixture
def watch(repository: Repository, tmp_path: Path) -> Watch:
    return Watch(repository, tmp_path)


def test_without_any_gateway_a_report_fails_in_words_and_the_schedule_goes_on(watch: Watch) -> None:
    watch.problem = "1 of 1: the collector process is not running"
    report = watch.ask()
    watch.passes(LIMIT_S)
    assert watch.state(report) is RecordingRequestState.REQUESTED
    assert watch.repository.schedule_recording(MOTOR, due_ns=NOW_NS, now_ns=NOW_NS) is None
    watch.passes(2 * STEP_S)
    ended = watch.report(report)
    assert ended.state is RecordingRequestState.FAILED
    assert ended.reason is not None
    assert f"{RELAY}: no gateway has visited the relay for 62 s: gateways do not run (1 of 1" in ended.reason
    assert "log" in ended.reason
    assert watch.repository.schedule_recording(MOTOR, due_ns=NOW_NS, now_ns=NOW_NS) is not None


def test_a_relay_no_gateway_has_room_for_is_told(watch: Watch) -> None:
    with watch.gateway(OTHER):
        report = watch.ask()
        watch.passes(LIMIT_S + 2 * STEP_S)
    assert "relays_per_gateway" in (watch.report(report).reason or "")


def test_a_relay_that_was_set_aside_is_told(watch: Watch) -> None:
    watch.repository.set_aside(RELAY, "it bites", backoff=Backoff(9.0, 9.0), now_ns=NOW_NS)
    report = watch.ask()
    watch.passes(LIMIT_S + 2 * STEP_S)
    assert f"it was set aside, it bites; see GET /api/v1/ieds/{RELAY}" in (watch.report(report).reason or "")


def test_a_relay_that_left_the_plant_is_told(watch: Watch) -> None:
    report = watch.ask()
    watch.repository.sync_plant(Plant(sites=(), relays=(), motors=()))
    watch.passes(LIMIT_S + 2 * STEP_S)
    assert "not in the plant's files any more" in (watch.report(report).reason or "")


def test_what_a_gateway_holds_is_never_ended_here(watch: Watch) -> None:
    """A long queue at a relay that answers, or a link that is down: the gateway sees to both."""
    with watch.gateway(RELAY):
        queue = [watch.ask() for _ in range(3)]
        watch.passes(3 * LIMIT_S)
        assert {watch.state(each) for each in queue} == {RecordingRequestState.REQUESTED}
    watch.passes(LIMIT_S)
    assert {watch.state(each) for each in queue} == {RecordingRequestState.REQUESTED}, "its time begins anew"


def test_gateways_that_crash_again_and_again_do_not_keep_a_report_open(watch: Watch) -> None:
    report = watch.ask()
    for _ in range(10):
        watch.passes(8.0)
        with watch.gateway(RELAY):
            watch.passes(4.0)
    watch.passes(2 * STEP_S)
    assert watch.state(report) is RecordingRequestState.FAILED


def test_the_leases_of_a_host_that_died_count_for_nothing(watch: Watch) -> None:
    watch.takes(RELAY)
    report = watch.ask()
    watch.passes(LEASE_S + LIMIT_S + 3 * STEP_S)
    assert watch.state(report) is RecordingRequestState.FAILED
    assert watch.repository.gateways() == ()


@pytest.mark.parametrize("state", [RecordingRequestState.TRIGGERED, RecordingRequestState.RECORDED])
def test_a_report_that_was_triggered_is_kept_for_an_hour(watch: Watch, state: RecordingRequestState) -> None:
    report = watch.ask()
    watch.repository.mark_triggered(report, now_ns=NOW_NS)
    if state is RecordingRequestState.RECORDED:
        watch.repository.mark_recorded(report, now_ns=NOW_NS)
    watch.passes(TRIGGERED_LIMIT_S, step_s=60.0)
    assert watch.state(report) is state
    watch.passes(2 * STEP_S)
    ended = watch.report(report)
    assert ended.state is RecordingRequestState.FAILED
    assert "it was triggered" in (ended.reason or "")


def test_a_report_that_a_gateway_took_up_meanwhile_is_not_ended(watch: Watch) -> None:
    seen = watch.report(watch.ask())
    watch.takes(RELAY)
    assert not watch.repository.fail_orphaned_request(seen, "why", now_ns=NOW_NS)
    watch.repository.end_gateway("g", now_ns=NOW_NS)
    watch.repository.mark_triggered(seen.id, now_ns=NOW_NS)
    assert not watch.repository.fail_orphaned_request(seen, "why", now_ns=NOW_NS)
    assert watch.state(seen.id) is RecordingRequestState.TRIGGERED


def test_without_running_gateways_the_reason_says_so(repository: Repository, tmp_path: Path) -> None:
    settings = Settings(data_directory=tmp_path, record_timeout_s=0.1, lease_s=1.0)
    report = repository.request_recording(MOTOR, now_ns=NOW_NS).id
    gateways = GatewayProcesses(settings, two_motor_plant(), repository)
    ender = OrphanedRequestEnder(
        settings, repository, gateway_problem=gateways.not_running, restart_delay_s=0.0
    )
    for now_s in (0.0, 1.0, 2.0):
        ender.end_overdue(now_s)
    assert "the collector process is not running" in (repository.recording_request(report).reason or "")
