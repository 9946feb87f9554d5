"""Each figure of the catalogue has a trend: its value as it was found, with what stands beside it."""

from typing import Any

import pytest

from core.quantities import BY_NAME, TRENDED, Subject, of_subject
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository
from service.storage.records.history import TrendPoint
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    LOSSES,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)

MOTOR = "PUMP-A1"
FOUND: dict[Subject, Any] = {
    Subject.ROTOR: BROKEN_ROTOR,
    Subject.AIR_GAP: ECCENTRIC_ROTOR,
    Subject.LOAD: SWINGING_LOAD,
    Subject.SUPPLY: SUPPLY,
    Subject.LOSSES: LOSSES,
}
OF_RECORDS = [name for name in TRENDED if BY_NAME[name].subject in FOUND]


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    examined = ExaminedRecordings(repository, store)
    examined.add(
        BROKEN_ROTOR,
        SUPPLY,
        eccentricity=ECCENTRIC_ROTOR,
        pulsation=SWINGING_LOAD,
        losses=LOSSES,
        diagnosis=fault(0.05),
    )
    return examined


def only(recorded: ExaminedRecordings, quantity: str) -> TrendPoint:
    (point,) = recorded.repository.trend(MOTOR, quantity, limit=9).items
    return point


def test_each_value_is_the_one_that_was_found(recorded: ExaminedRecordings) -> None:
    assert len(OF_RECORDS) > 20
    for name in OF_RECORDS:
        quantity = BY_NAME[name]
        point = only(recorded, name)
        assert point.value == getattr(FOUND[quantity.subject], quantity.attribute), name
        assert point.time_ns == NOW_NS + SECOND_NS


def test_intervals_come_from_their_ends_or_from_the_deviation(recorded: ExaminedRecordings) -> None:
    assert only(recorded, "rotor_severity_dB").ci95 == BROKEN_ROTOR.severity_dB_ci95
    assert only(recorded, "efficiency").ci95 == LOSSES.efficiency_ci95
    assert only(recorded, "rotor_severity_dB").detection_limit == BROKEN_ROTOR.detection_limit_dB
    assert only(recorded, "rotor_severity_dB").state == "fault"
    assert only(recorded, "gap_permeance_ripple").ci95 == pytest.approx((0.0525 - 0.00392, 0.0525 + 0.00392))
    assert only(recorded, "gap_permeance_ripple").detection_limit == ECCENTRIC_ROTOR.detection_limit
    assert only(recorded, "turn_load_torque").ci95 == pytest.approx((0.0, 0.001 + 0.00392)), "not below zero"
    level = only(recorded, "mu_f")
    assert (level.value, level.verdict) == (0.05, "fault")
    assert level.ci95 == pytest.approx((0.046, 0.054))
    assert level.scatter95 == pytest.approx((0.049, 0.051))
    assert only(recorded, "power_factor").ci95 is None


def test_all_figures_of_a_subject_come_in_the_order_of_the_catalogue(recorded: ExaminedRecordings) -> None:
    for subject, finding in FOUND.items():
        (point,) = recorded.repository.subject_trend(MOTOR, subject, limit=9).items
        for quantity, value in zip(of_subject(subject), point.values, strict=True):
            if "ci95" not in quantity.name:
                assert value == getattr(finding, quantity.attribute), quantity.name


def test_a_record_that_tells_nothing_of_a_subject_is_not_in_its_trend(recorded: ExaminedRecordings) -> None:
    recorded.add(BROKEN_ROTOR)
    assert len(recorded.repository.trend(MOTOR, "slip", limit=9).items) == 2
    for name in ("thd_voltage", "efficiency"):
        assert len(recorded.repository.trend(MOTOR, name, limit=9).items) == 1
    recorded.add(BROKEN_ROTOR, diagnosis=undiagnosable())
    for name in ("slip", "swing_load_torque", "gap_permeance_ripple"):
        assert len(recorded.repository.trend(MOTOR, name, limit=9).items) == 2


def test_there_is_no_such_motor(recorded: ExaminedRecordings) -> None:
    for name in ("mu_f", "change", "slip", "thd_voltage", "stator_resistance_change"):
        with pytest.raises(NotFoundError, match=MOTOR):
            recorded.repository.trend("PUMP-A", name, limit=1)
