"""Series of records that are joined: a relay is triggered again and again, over real MMS."""

import time
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

from core.operation import Operation
from core.recordings import read
from ied_sim.relay.event_recorder import RecorderSettings
from service.background.joining import SeriesJoiner
from service.background.long_records import LongRecorder
from service.collector.triggers.series import SeriesUnderWay
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.plant import PlantMotor
from service.plant.series_rhythm import NoSeriesError, rhythm_of
from service.storage.records import RecordingEntry, RecordingRequest, Sample
from service.storage.states import (
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)
from service.waveforms.computing import compute_here
from testing.relays.simulated import scenario_of, simulated
from testing.service.plants import motor
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.session.test_simulated_relays import of

RECORDER = RecorderSettings(sample_rate_hz=1_600.0, pre_trigger_s=0.4, post_trigger_s=0.3, capacity=12)
WANTED_S = 2.0
TRIGGERS = 4
LONGER_S, LONGER_TRIGGERS = 3.5, 7
LONG_PRE_TRIGGER = replace(RECORDER, pre_trigger_s=1.2)
"""Records that overlap though a busy machine triggers late by half a second."""
LONGEST_S = 6.0
RUNNER = "here"


def diagnose_all(bench: Bench) -> None:
    """Do the jobs that wait, in this process."""
    repository = bench.repository
    while (claimed := repository.claim_job(now_ns=time.time_ns(), runner=RUNNER)) is not None:
        source = bench.store.source(claimed.digest)
        made = diagnose_recording(DiagnosisTask(source, motor(MOTOR), claimed.job.method, claimed.job.model))
        assert isinstance(made, Diagnosed), made
        assert repository.finish_job(
            claimed.job.id,
            made.findings,
            recorded_ns=made.recorded_ns,
            now_ns=time.time_ns(),
            runner=RUNNER,
        )


def joiner(bench: Bench) -> SeriesJoiner:
    return SeriesJoiner(bench.repository, bench.store, compute_here, time_zones={}, patience_s=60.0)


def fetched(bench: Bench, number: int) -> bool:
    stored = [one for one in bench.recordings() if one.digest is not None]
    return len(stored) == number


def ask(bench: Bench, seconds: float | None) -> str:
    return bench.repository.request_recording(MOTOR, now_ns=time.time_ns(), seconds=seconds).id


@pytest.fixture
def ready(bench: Bench) -> Bench:
    bench.repository.register_runner(RUNNER, installation="here", now_ns=time.time_ns(), max_attempts=3)
    return bench


def test_a_series_is_recorded_joined_and_diagnosed_beside_its_parts(ready: Bench, tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", recorder=RECORDER)
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(ready, served, "EVENTS")
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            too_soon = ask(here, WANTED_S)
            session.wake()
            assert here.reaches(too_soon, RecordingRequestState.FAILED)
            once = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(once).state is RecordingRequestState.FETCHED, 20)
            diagnose_all(here)
            wanted = ask(here, WANTED_S)
            session.wake()
            assert eventually(lambda: fetched(here, 1 + TRIGGERS), 30)
    assert "record the motor once, and ask again" in (here.requested(too_soon).reason or "")
    diagnose_all(here)
    joiner(here).join_ready(time.time_ns())
    request = here.requested(wanted)
    assert request.triggers == TRIGGERS
    assert request.joined_remark is None
    made = here.repository.recording(request.joined_recording_id or "")
    assert made.source is RecordingSource.JOINED
    assert made.parts is not None
    assert request.recording_id == made.parts[0]
    parts = [here.repository.recording(part) for part in made.parts]
    assert len(parts) == TRIGGERS
    assert all(part.state is RecordingState.DIAGNOSED for part in parts)
    assert_goes_on(here, made)

    diagnose_all(here)
    made = here.repository.recording(made.id)
    assert made.state is RecordingState.DIAGNOSED
    assert made.duration_s == pytest.approx(WANTED_S, abs=RECORDER.pre_trigger_s)
    assert made.recorded_ns == parts[0].recorded_ns
    assert [one.duration_s for one in parts] == pytest.approx([0.7] * TRIGGERS)
    assert [one.pre_trigger_s for one in parts] == pytest.approx([0.4] * TRIGGERS)

    before = here.recordings()
    joiner(here).join_ready(time.time_ns())
    assert here.recordings() == before


def assert_goes_on(bench: Bench, made: RecordingEntry) -> None:
    """The joined waveform has no step: each sample is near that of the sinusoid through its neighbours."""
    assert made.digest is not None
    record = read(bench.store.entry(made.digest))
    assert record.has_time_code
    cosine = 2 * np.cos(2 * np.pi * 50.0 / record.sample_rate_hz)
    x = record.samples
    surprise = x[:, 2:] - cosine * x[:, 1:-1] + x[:, :-2]
    assert (np.abs(surprise).max(axis=1) < 0.05 * np.abs(x).max(axis=1)).all()


def test_what_came_of_a_series_is_joined_when_the_rest_does_not_come(ready: Bench, tmp_path: Path) -> None:
    """A relay that keeps two records loses the others before they can be fetched."""
    scenario = scenario_of("sel-710-ed2", recorder=replace(RECORDER, capacity=2))
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(ready, served, "EVENTS")
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            once = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(once).state is RecordingRequestState.FETCHED, 20)
            diagnose_all(here)
            wanted = ask(here, WANTED_S)
            session.wake()
            assert eventually(lambda: fetched(here, 3), 30)
    diagnose_all(here)
    patient, now_ns = joiner(here), time.time_ns()
    patient.join_ready(now_ns)
    assert here.requested(wanted).joined_recording_id is None
    patient.join_ready(now_ns + 61 * 10**9)
    request = here.requested(wanted)
    assert request.joined_remark == "only 2 of its recordings came"
    made = here.repository.recording(request.joined_recording_id or "")
    assert made.parts is not None
    assert len(made.parts) == 2


@pytest.mark.parametrize(("before", "parts"), [(3, 3), (0, 0)])
def test_a_trip_ends_a_series(ready: Bench, tmp_path: Path, before: int, parts: int) -> None:
    """What came before it is joined at once, from two recordings on; the one of the trip is none of them."""
    scenario = scenario_of("sel-710-ed2", recorder=LONG_PRE_TRIGGER)
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(ready, served, "EVENTS")
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            once = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(once).state is RecordingRequestState.FETCHED, 20)
            diagnose_all(here)
            wanted = ask(here, LONGEST_S)
            session.wake()
            assert eventually(lambda: fetched(here, 1 + before), 30)
            served.relay._trip(["overcurrent"], served.relay._clock.now_ns())
            assert eventually(lambda: here.requested(wanted).state is RecordingRequestState.FETCHED, 30)
            assert eventually(lambda: trips_and_standstills(here), 30)
    joiner(here).join_ready(time.time_ns())
    request = here.requested(wanted)
    ended_by = trips_and_standstills(here)[0]
    assert request.joined_remark is not None
    assert ended_by.name in request.joined_remark
    assert "the relay trips the motor" in request.joined_remark
    assert "/" not in request.joined_remark
    if parts == 0:
        assert request.joined_recording_id is None
        return
    made = here.repository.recording(request.joined_recording_id or "")
    assert made.parts is not None
    assert len(made.parts) >= parts
    for part in made.parts:
        assert here.repository.recording(part).operation is Operation.RUNNING
    diagnose_all(here)
    assert here.repository.recording(made.id).operation is Operation.RUNNING


def trips_and_standstills(bench: Bench) -> list[RecordingEntry]:
    """Have all recordings diagnosed, and return those in which the motor runs no longer, by their time."""
    diagnose_all(bench)
    found = [one for one in bench.recordings() if one.operation in {Operation.TRIP, Operation.NOT_RUNNING}]
    return sorted(found, key=lambda one: one.recorded_ns or 0)


@pytest.mark.parametrize(
    ("length", "seconds", "triggers", "period_s"),
    [((1.28, 0.4), 10.0, 10, 1.08), ((1.0, 0.2), 10.0, 11, 0.9), ((0.5, 0.3), 0.4, 1, 0.35)],
)
def test_triggers_come_in_the_middle_of_the_pre_trigger_time(
    length: tuple[float, float], seconds: float, triggers: int, period_s: float
) -> None:
    rhythm = rhythm_of(length, seconds)
    assert rhythm.triggers == triggers
    assert rhythm.period_s == pytest.approx(period_s)
    assert (rhythm.triggers - 1) * rhythm.period_s + length[0] >= seconds


@pytest.mark.parametrize(
    ("length", "seconds", "said"),
    [
        (None, 10.0, "record the motor once"),
        ((1.0, 0.05), 10.0, "PRE"),
        ((0.25, 0.1), 30.0, "LER"),
    ],
)
def test_a_relay_that_cannot_make_a_series_is_told_apart(
    length: tuple[float, float] | None, seconds: float, said: str
) -> None:
    with pytest.raises(NoSeriesError, match=said):
        rhythm_of(length, seconds)


def test_between_the_triggers_of_a_series_the_relay_is_measured_and_records_are_fetched(
    ready: Bench, tmp_path: Path
) -> None:
    """The next request waits until all records of the series came."""
    scenario = scenario_of("sel-710-ed2", recorder=RECORDER)
    samples: list[Sample] = []
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(ready, served, "EVENTS").with_settings(metering_period_s=0.2, record_timeout_s=20.0)
        with here.session(samples.append) as session:
            once = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(once).state is RecordingRequestState.FETCHED, 20)
            diagnose_all(here)
            wanted = ask(here, LONGER_S)
            after = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(after).state is RecordingRequestState.FETCHED, 40)
    assert here.requested(wanted).triggers == LONGER_TRIGGERS
    diagnose_all(here)
    records = sorted(here.recordings(), key=lambda one: one.recorded_ns or 0)
    assert len(records) == 1 + LONGER_TRIGGERS + 1
    first, *_, last = records[1:-1]
    assert (here.requested(wanted).recording_id, here.requested(after).recording_id) == (
        first.id,
        records[-1].id,
    )
    begun_ns, ended_ns = here.requested(wanted).triggered_ns or 0, last.recorded_ns or 0
    assert first.fetched_ns is not None
    assert first.fetched_ns < ended_ns
    meanwhile = [sample for sample in samples if begun_ns < sample.time_ns < ended_ns]
    assert len(meanwhile) >= LONGER_TRIGGERS, "at least one sample from trigger to trigger"


@pytest.mark.campaign
def test_a_long_record_is_made_by_its_interval_once_motor_and_link_are_steady(
    ready: Bench, tmp_path: Path
) -> None:
    scenario = scenario_of("sel-710-ed2", recorder=RECORDER)
    due = PlantMotor(motor(MOTOR), "pump", "FACTORY_A", ready.relay.name, None, None, 7.0, WANTED_S)
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(ready, served, "EVENTS").with_settings(metering_period_s=0.2, record_timeout_s=20.0)
        repository = here.repository
        long_records = LongRecorder(
            [due], repository, usual_days=0.0, usual_s=10.0, metering_period_s=0.2, steady_s=1.0
        )
        with here.session(lambda sample: repository.add_samples([sample])) as session:
            once = ask(here, None)
            session.wake()
            assert eventually(lambda: here.requested(once).state is RecordingRequestState.FETCHED, 20)
            diagnose_all(here)

            def asked() -> list[RecordingRequest]:
                long_records.request_due(time.time_ns())
                session.wake()
                return [one for one in repository.recording_requests(limit=10).items if one.seconds]

            assert eventually(lambda: asked() != [], 20)
            assert eventually(lambda: fetched(here, 1 + TRIGGERS), 40)
            (wanted,) = asked()
    diagnose_all(here)
    joiner(here).join_ready(time.time_ns())
    request = here.requested(wanted.id)
    assert (request.joined_remark, request.origin) == (None, RecordingRequestOrigin.SCHEDULE)
    assert request.joined_recording_id is not None


def test_after_a_late_trigger_the_next_keeps_its_distance() -> None:
    """A relay takes no trigger while it records: one in time with the first would be lost."""
    rhythm = rhythm_of((0.7, 0.4), WANTED_S)
    series = SeriesUnderWay("RB", rhythm, began_s=100.0, record_timeout_s=20.0)
    late_s = 100.0 + 1.9 * rhythm.period_s
    series.triggered(late_s)
    assert series.due_in_s(late_s) == pytest.approx(rhythm.period_s)


def test_a_series_waits_for_its_records_but_not_for_ever() -> None:
    rhythm = rhythm_of((0.7, 0.4), WANTED_S)
    series = SeriesUnderWay("RB", rhythm, began_s=100.0, record_timeout_s=20.0)
    assert series.due_in_s(100.0) == pytest.approx(rhythm.period_s)
    last_s = 100.0
    for _ in range(rhythm.triggers - 1):
        assert not series.is_over(1_000.0)
        last_s += series.due_in_s(last_s)
        series.triggered(last_s)
    assert series.due_in_s(101.0) == inf
    assert last_s == pytest.approx(100.0 + (rhythm.triggers - 1) * rhythm.period_s)
    assert not series.is_over(last_s + 19.9)
    assert series.is_over(last_s + 20.1)
    for _ in range(rhythm.triggers):
        series.came()
    assert series.is_over(last_s)
