"""Parameters followed along with the folds of a motor's condition."""

import random
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from core.condition.events import Event, EventKind
from core.condition.observation import Observation
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState
from core.tracking.follower import REFERENCE_RECORDS, Follower
from core.tracking.telling import tracked_parameters
from service.condition.tracking import Tracking
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import SERVICE, FollowedStart, RecordObservation
from testing.service.following import PUMP, Recorder, fold_all
from testing.service.observations import HOUR_NS
from testing.service.plants import NOW_NS, motor
from testing.service.tracked_records import tracked_records

WRONG_FROM = REFERENCE_RECORDS + 10
RECORDS = tracked_records(motor(PUMP).parameters, WRONG_FROM + 20, wrong_from=WRONG_FROM)


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    return Recorder(repository, store)


def expected(records: Sequence[Observation] = RECORDS) -> TrackedParameters:
    follower = Follower(motor(PUMP))
    for record in records:
        follower.follow(record)
    return tracked_parameters(follower)


def require_same(repository: Repository, wanted: TrackedParameters) -> None:
    found = repository.tracked_parameters(PUMP)
    assert found is not None
    assert (found.state, found.records, found.causes) == (wanted.state, wanted.records, wanted.causes)
    for one, other in zip(found.parameters, wanted.parameters, strict=True):
        np.testing.assert_allclose(one.change_ci95, other.change_ci95, rtol=1e-6)


def kinds_of_alarms(repository: Repository) -> list[str]:
    alarms = repository.open_alarms(motor=PUMP, limit=10).items
    return [one.kind for one in alarms if one.subject == "parameters" and one.cleared_ns is None]


def test_folds_in_any_order_follow_the_parameters_as_all_records_at_once(
    repository: Repository, recorder: Recorder
) -> None:
    order = list(RECORDS)
    random.Random(7).shuffle(order)
    for some in (order[:3], order[3:30], order[30:]):
        recorder.record_all(some)
        fold_all(repository)
    require_same(repository, expected())
    points = repository.tracked_trend(PUMP, limit=100).items
    assert [one.time_ns for one in points] == [record.time_ns for record in RECORDS]
    known = [one.magnetising_inductance_change is not None for one in points]
    assert known == [at >= REFERENCE_RECORDS - 1 for at in range(len(RECORDS))]
    assert repository.latest_tracked_points(PUMP, limit=5) == tuple(points[-5:])


def test_another_ratio_raises_an_alarm_that_ends_with_the_reference(
    repository: Repository, recorder: Recorder
) -> None:
    recorder.record_all(RECORDS[:WRONG_FROM])
    fold_all(repository)
    assert kinds_of_alarms(repository) == []
    recorder.record_all(RECORDS[WRONG_FROM:])
    fold_all(repository)
    found = repository.tracked_parameters(PUMP)
    assert found is not None
    assert found.causes == (DriftCause.RATIO,)
    (alarm,) = [
        one for one in repository.open_alarms(motor=PUMP, limit=10).items if one.subject == "parameters"
    ]
    assert alarm.kind == "parameter-drift"
    assert "magnetising inductance +5" in alarm.reason
    assert "a CT or VT ratio changed" in alarm.reason
    assert alarm.advice is not None
    assert alarm.advice.startswith("Compare ratios and burdens")

    restarted = Event(RECORDS[-1].time_ns + 1, EventKind.REFERENCE_RESTARTED, "new transformers")
    repository.add_event(PUMP, restarted, by=SERVICE, now_ns=NOW_NS)
    fold_all(repository)
    assert kinds_of_alarms(repository) == []
    found = repository.tracked_parameters(PUMP)
    assert found is not None
    assert found.records == 0


def test_maintenance_begins_no_new_reference_for_what_it_changes_is_to_be_told(
    repository: Repository, recorder: Recorder
) -> None:
    recorder.record_all(RECORDS)
    worked = Event(RECORDS[WRONG_FROM].time_ns - 1, EventKind.MAINTENANCE, "transformers cleaned")
    repository.add_event(PUMP, worked, by=SERVICE, now_ns=NOW_NS)
    fold_all(repository)
    require_same(repository, expected())


def test_a_record_that_is_deleted_counts_no_more(repository: Repository, recorder: Recorder) -> None:
    ids = recorder.record_all(RECORDS)
    fold_all(repository)
    repository.delete_recording(ids[12], "of another motor", now_ns=NOW_NS)
    fold_all(repository)
    require_same(repository, expected([*RECORDS[:12], *RECORDS[13:]]))


def test_edited_parameters_begin_another_reference() -> None:
    plain = motor(PUMP)
    other = replace(plain, parameters=replace(plain.parameters, rotor_resistance_ohm=9.1))
    tracking = Tracking.begun(plain, ())
    tracking.apply(Event(NOW_NS, EventKind.PARAMETERS_EDITED), other)
    found = tracking.found()
    assert TrackedParameters.from_dict(found).parameters[1].reference == 9.1


def test_starts_are_followed_in_their_order_among_records() -> None:

    starts = [
        FollowedStart(NOW_NS + 10 * HOUR_NS, 1.0, 0.01),
        FollowedStart(NOW_NS + 200 * HOUR_NS, 1.5, 0.01),
    ]
    whole, parted = Tracking.begun(motor(PUMP), starts), Tracking.begun(motor(PUMP), starts[:1])
    for at, record in enumerate(RECORDS):
        whole.follow(RecordObservation(str(at), PUMP, record))
        parted.follow(RecordObservation(str(at), PUMP, record))
    again = Tracking.restored(motor(PUMP), parted.document(), starts[1:])
    whole.follow_starts()
    again.follow_starts()
    one, other = whole.found(), again.found()
    rotor = TrackedParameters.from_dict(one).parameters[1]
    assert rotor.state is TrackedParameters.from_dict(other).parameters[1].state
    assert rotor.state is not TrackingState.UNDETERMINED
