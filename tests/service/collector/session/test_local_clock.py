"""A relay whose clock runs in local time, over real MMS, from the trigger to the record's time."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from core.time_stamps import rfc3339
from ied_sim.relay.configuration import RelayConfiguration
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.worker import diagnose_recording
from service.storage.records import RecordingEntry
from service.storage.states import AlarmKind, RecordingState
from service.timing.backoff import Backoff
from testing.relays.simulated import scenario_of, simulated
from testing.service.plants import motor
from testing.waiting import wait_until
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.expectations import at, expecting
from tests.service.collector.scripted_relay import NAME
from tests.service.collector.session.test_discovery import scl_of

ZONE = "Asia/Kolkata"
LIMITS = JobLimits(workers=1, job_timeout_s=60.0, attempts=1, backoff=Backoff(0.01, 0.1), lease_s=30.0)
NEAR_NS = 30 * 10**9


def in_local_time(revision: int) -> RelayConfiguration:
    scenario = scenario_of("sel-710-ed2")
    record = scenario.profile.record.model_copy(update={"formats": (f"COMTRADE {revision} BINARY",)})
    profile = scenario.profile.model_copy(update={"record": record})
    return replace(scenario, profile=profile, time_zone=ZoneInfo(ZONE))


def triggered_and_diagnosed(bench: Bench, zones: Mapping[str, str]) -> tuple[RecordingEntry, int]:
    """A record that the service asks for, and the time of its trigger."""
    known = {recording.id for recording in bench.recordings()}
    request_id = bench.request()
    with bench.session():
        wait_until(lambda: bench.requested(request_id).recording_id is not None, within_s=20)
    runner = JobRunner(
        bench.repository,
        bench.store,
        {MOTOR: motor(MOTOR)},
        diagnose_recording,
        limits=LIMITS,
        installation="tests",
        time_zones=zones,
        poll_period_s=0.05,
    )
    runner.start()
    try:
        (new,) = [one.id for one in bench.recordings() if one.id not in known]
        wait_until(lambda: bench.repository.recording(new).state is RecordingState.DIAGNOSED, within_s=60)
    finally:
        runner.stop()
    triggered_ns = bench.requested(request_id).triggered_ns
    assert triggered_ns is not None
    return bench.repository.recording(new), triggered_ns


def reason(bench: Bench) -> str:
    (alarm,) = [one for one in bench.repository.standing_alarms(NAME) if one.kind is AlarmKind.TIME_ZONE]
    return alarm.reason


@pytest.mark.campaign
def test_hours_off_are_an_alarm_with_the_cure_and_the_cure_helps(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", in_local_time(1999)) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2")), served)
        recording, triggered_ns = triggered_and_diagnosed(here, {})
        assert recording.recorded_ns is not None
        half_past_five_ns = 5 * 3600 * 10**9 + 1800 * 10**9
        assert abs(recording.recorded_ns - triggered_ns - half_past_five_ns) < NEAR_NS
        assert "5 h 30 min ahead: the relay's clock runs in local time: set time_zone in" in reason(here)
        assert rfc3339(triggered_ns) in reason(here)
        recording, triggered_ns = triggered_and_diagnosed(here, {MOTOR: ZONE})
        assert recording.recorded_ns is not None
        assert abs(recording.recorded_ns - triggered_ns) < NEAR_NS
        assert AlarmKind.TIME_ZONE not in here.alarms()
        triggered_and_diagnosed(here, {MOTOR: "Europe/Berlin"})
        assert AlarmKind.TIME_ZONE not in here.alarms()  # a clock may have been set: the next record tells
        triggered_and_diagnosed(here, {MOTOR: "Europe/Berlin"})
        assert "the motors file says that its clock runs in Europe/Berlin, and it does not" in reason(here)


@pytest.mark.campaign
def test_a_record_that_tells_its_zone_needs_no_setting(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", in_local_time(2013)) as served:
        here = at(expecting(bench, scl_of("sel-710-ed2")), served)
        for zones in ({}, {MOTOR: ZONE}):
            recording, triggered_ns = triggered_and_diagnosed(here, zones)
            assert recording.recorded_ns is not None
            assert abs(recording.recorded_ns - triggered_ns) < NEAR_NS
        assert here.alarms() == {}
