"""Motors of a bus are told the same, bit for bit, in whatever order their records have arrived."""

from dataclasses import replace
from functools import cache

from hypothesis import given, settings
from hypothesis import strategies as st

from core.condition.bus.bus_records import BusRecords
from core.condition.following.follower import Follower
from core.condition.observation import Observation
from core.machines.parameters import Motor
from tests.core.condition.simulated import Plant, motor_of

NAMES = ("P-1", "P-2", "P-3", "P-4")
RECORDS = 24
SECOND_NS = 10**9

Arrival = tuple[Motor, Observation]


@cache
def records_of_the_bus() -> tuple[Arrival, ...]:
    """Motors on one supply, recorded within a minute of each other; a channel of the first one jumps."""
    records = []
    for k, name in enumerate(NAMES):
        plant = Plant(seed=7, voltage=[1.0 + 0.001 * k, 0.998, 1.002 - 0.001j * k], load=(0.5 + 0.1 * k, 0.9))
        motor = replace(motor_of(), name=name)
        for n in range(RECORDS):
            if name == NAMES[0] and n == RECORDS - 6:
                plant.voltage[2] *= 1.02
            record = plant.record()
            # Of two neighbours one is as far before a record as another one of the same motor is after it.
            records.append((motor, replace(record, time_ns=record.time_ns + 7 * k * SECOND_NS)))
            if k == 1 and n % 5 == 0:
                records.append((motor, replace(record, time_ns=record.time_ns + 14 * SECOND_NS)))
            if k == 3 and n % 4 == 0:
                voltage = 1.1 * record.negative_voltage_V
                same_time = replace(record, time_ns=records[-1][1].time_ns, negative_voltage_V=voltage)
                records.append((motor, same_time))
    return tuple(records)


def told(arrived: list[Arrival]) -> list[object]:
    """State, standing asymmetry and assessment of every motor, once all is folded in the order of time."""
    followers = {}
    for motor in {one.name: one for one, _ in arrived}.values():
        others = BusRecords((one, seen) for one, seen in arrived if one.name != motor.name)
        follower = followers[motor.name] = Follower(motor)
        own = [seen for one, seen in arrived if one.name == motor.name]
        for seen in sorted(own, key=lambda one: (one.time_ns, abs(one.negative_voltage_V))):
            follower.fold(seen, others.neighbours(seen.time_ns))
    estimates = [one.standing_estimate() for one in followers.values()]
    standings = [one for one in estimates if one is not None]
    return [
        (
            followers[name].save(),
            followers[name].assessment([one for one in standings if one.motor != name]),
        )
        for name in NAMES
    ]


@settings(deadline=None, max_examples=6)
@given(arrived=st.permutations(records_of_the_bus()))
def test_the_order_of_arrival_changes_no_bit(arrived: list[Arrival]) -> None:
    assert told(arrived) == told(list(records_of_the_bus()))
