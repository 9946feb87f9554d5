"""What the other motors of a bus saw at about the time of a record."""

from core.condition.bus.bus_records import BusRecords
from core.condition.observation import SAME_SUPPLY_WITHIN_NS, Observation, VoltageChannels
from core.signals.sequence import PhaseSequence
from core.units import NANOSECONDS_PER_SECOND
from testing.machines.motors import MEDIUM, REFERENCE


def seen(time_s: float, negative_voltage_V: float, positive_voltage_V: float = 100.0) -> Observation:
    return Observation(
        time_ns=round(time_s * NANOSECONDS_PER_SECOND),
        recorder="",
        sequence=PhaseSequence.ABC,
        voltage_channels=VoltageChannels.PHASE,
        frequency_hz=50.0,
        positive_voltage_V=complex(positive_voltage_V),
        negative_voltage_V=complex(negative_voltage_V),
        zero_voltage_V=None,
        positive_current_A=1.0 - 0.5j,
        negative_current_A=0.0j,
        zero_current_A=0.0j,
        scatter=1e-8,
        cycles=10,
    )


def test_the_nearest_record_of_each_motor_within_a_minute_tells() -> None:
    records = BusRecords(
        [
            (REFERENCE, seen(70, 3.0)),
            (REFERENCE, seen(110, 2.0)),
            (MEDIUM, seen(160, 1.0)),
            (MEDIUM, seen(160.1, 9.0)),
            (MEDIUM, seen(99, 5.0, positive_voltage_V=0.0)),
        ]
    )
    found = {
        one.motor: one.negative_voltage_ratio for one in records.neighbours(100 * NANOSECONDS_PER_SECOND)
    }
    assert found == {MEDIUM.name: 0.01, REFERENCE.name: 0.02}
    assert records.neighbours(0) == []
    edge_ns = 70 * NANOSECONDS_PER_SECOND - SAME_SUPPLY_WITHIN_NS
    assert [one.motor for one in records.neighbours(edge_ns)] == [REFERENCE.name]
    assert records.neighbours(edge_ns - 1) == []
