"""A follower's records go in one by one, and its state survives being saved."""

import json
from dataclasses import replace

import numpy as np
import pytest

from core.condition.bus.bus_records import BusRecords
from core.condition.errors import ObservationError
from core.condition.events import Event, EventKind
from core.condition.following.follower import Follower
from core.condition.kinds import State
from core.condition.observation import Observation, VoltageChannels
from core.condition.verdict.judging import condition_of
from core.machines.parameters import MachineParameters, Motor, Nameplate
from core.signals.sequence import PhaseSequence

MOTOR = Motor(
    "P-101",
    Nameplate(rated_power_W=800.0, rated_voltage_V=380.0, rated_frequency_Hz=50.0, pole_pairs=2),
    MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229),
)
HOUR_NS = 3600 * 10**9


def healthy_records(count: int, seed: int = 1) -> list[Observation]:
    rng = np.random.default_rng(seed)
    Z2 = complex(15.0, 20.5)
    records = []
    for k in range(count):
        v2 = 0.01 * np.exp(2j * np.pi * rng.random()) * rng.random()
        I1 = rng.uniform(1.0, 2.0) * np.exp(-0.7j)
        noise = 2e-4 * complex(*rng.normal(size=2))
        records.append(
            Observation(
                time_ns=k * HOUR_NS, recorder="relay", sequence=PhaseSequence.ABC,
                voltage_channels=VoltageChannels.PHASE, frequency_hz=50.0,
                positive_voltage_V=310.0 + 0.0j, negative_voltage_V=310.0 * (v2 + noise),
                zero_voltage_V=1.0 + 0.0j, positive_current_A=complex(I1),
                negative_current_A=310.0 * v2 / Z2, zero_current_A=0.01 + 0.0j, scatter=1e-8, cycles=20,
            )
        )  # fmt: skip
    return records


def follow(records: list[Observation]) -> Follower:
    follower = Follower(MOTOR)
    for record in records:
        follower.fold(record)
    return follower


@pytest.mark.parametrize("cut", [0, 3, 8, 9, 25])
def test_a_restart_in_between_changes_no_bit(cut: int) -> None:
    records = healthy_records(30)
    restored = Follower.restore(MOTOR, follow(records[:cut]).save())
    for record in records[cut:]:
        restored.fold(record)
    assert restored.save() == follow(records).save()


def test_a_missing_number_is_named_and_leaves_the_state_as_it_was() -> None:
    follower = follow(healthy_records(12))
    before = follower.save()
    record = replace(healthy_records(13)[-1], negative_current_A=complex("nan"))
    with pytest.raises(ValueError, match="negative_current_A"):
        follower.fold(record)
    assert follower.save() == before


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("negative_current_A", 1e200 + 0j),
        ("zero_voltage_V", 1e12 + 0j),
        ("positive_voltage_V", 0j),
        ("frequency_hz", 1e9),
        ("frequency_hz", float("nan")),
        ("scatter", 1e300),
        ("scatter", -1.0),
        ("load_level", float("nan")),
        ("recorder", "relay" * 2_000_000),
        ("cycles", 0),
    ],
)
def test_what_no_record_can_have_is_named_and_leaves_the_state_as_it_was(field: str, value: object) -> None:
    follower = follow(healthy_records(12))
    before = follower.save()
    record = replace(healthy_records(13)[-1], **{field: value})  # type: ignore[arg-type] # any field
    with pytest.raises(ObservationError, match=field):
        follower.fold(record)
    assert follower.save() == before


def test_an_impossible_record_of_a_neighbour_is_not_compared_with() -> None:
    (record,) = healthy_records(1)
    absurd = replace(record, negative_voltage_V=1e200 + 0j)
    assert not BusRecords([(MOTOR, absurd)]).neighbours(record.time_ns)
    assert BusRecords([(MOTOR, record)]).neighbours(record.time_ns)


def test_a_record_that_comes_late_is_refused() -> None:
    records = healthy_records(12)
    follower = follow(records)
    with pytest.raises(ValueError, match="fold from there"):
        follower.fold(records[3])


@pytest.mark.parametrize("kind", EventKind)
@pytest.mark.parametrize("count", [3, 12])
def test_an_event_after_the_latest_record_leaves_a_condition_that_can_be_told(
    kind: EventKind, count: int
) -> None:
    records = healthy_records(count + 1)
    follower = follow(records[:count])
    follower.apply(Event(count * HOUR_NS, kind, "worked at"))
    ends = kind not in (EventKind.NOTE, EventKind.PARAMETERS_EDITED)
    told = condition_of(MOTOR, follower.assessment(), count * HOUR_NS)
    assert json.loads(json.dumps(told.as_dict())) == told.as_dict()
    assert told.state is (State.UNKNOWN if ends else State.HEALTHY)
    assert (follower.standing_estimate() is None) is ends
    follower = Follower.restore(MOTOR, follower.save())
    follower.fold(records[count])
    assert condition_of(MOTOR, follower.assessment(), count * HOUR_NS).state is State.HEALTHY


ENDING = [
    EventKind.REWOUND, EventKind.MAINTENANCE, EventKind.RECORDER_CHANGED, EventKind.REFERENCE_RESTARTED,
]  # fmt: skip


@pytest.mark.parametrize("kind", ENDING)
def test_what_ended_the_reference_is_known_until_the_next_record(kind: EventKind) -> None:
    *records, latest = healthy_records(21)
    follower = follow(records)
    follower.apply(Event(records[-1].time_ns + 1, EventKind.NOTE, "hums"))
    assert follower.ended_by is None
    event = Event(records[-1].time_ns + 2, kind, "told by a person")
    follower.apply(event)
    assert follower.assessment() is None
    restored = Follower.restore(MOTOR, follower.save())
    assert restored.ended_by == event
    restored.fold(latest)
    assert restored.ended_by is None
