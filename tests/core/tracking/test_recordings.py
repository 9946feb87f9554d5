"""From recordings of the simulator to a drift: the real examination in between."""

from dataclasses import replace

from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.recordings import Recording
from core.tracking.finding import DriftCause, TrackingState
from core.tracking.follower import REFERENCE_RECORDS, Follower
from core.tracking.telling import tracked_parameters
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.disturbed_records import record_of
from testing.machines.motors import MEDIUM

RATE_HZ, HOUR_S = 5_000.0, 3_600
LOADS = (0.3, 0.9, 0.6, 0.45, 0.75)


def observed(number: int, current_gain: float) -> Observation:
    plate = MEDIUM.nameplate
    gains = (current_gain + 0.001, current_gain - 0.002, current_gain + 0.0015, 0.0, 0.001, -0.001)
    plant = MotorPlant(
        MEDIUM,
        Supply(
            plate.rated_voltage_V,
            plate.rated_frequency_Hz,
            unbalance=0.004,
            unbalance_angle_rad=2.4 * number,
        ),
        Load(LOADS[number % len(LOADS)]),
        Sensors(10.0 * rated_current(MEDIUM), 2.0 * plate.rated_voltage_V, gain_errors=gains, noise=1e-3),
        seed=number,
    )
    samples = plant.window(10.0, 0.5, RATE_HZ, step_rate_hz=10_000.0)
    record: Recording = record_of(samples, RATE_HZ)
    found = observe(replace(record, start_time_ns=number * HOUR_S * NANOSECONDS_PER_SECOND), MEDIUM)
    assert found is not None
    return found


def test_another_ratio_after_maintenance_is_told() -> None:
    follower = Follower(MEDIUM)
    for number in range(REFERENCE_RECORDS + 10):
        assert follower.follow(observed(number, 0.0))
    assert tracked_parameters(follower).state is not TrackingState.DRIFTING
    for number in range(REFERENCE_RECORDS + 10, REFERENCE_RECORDS + 22):
        follower.follow(observed(number, -0.04))
    found = tracked_parameters(follower)
    assert found.state is TrackingState.DRIFTING
    assert found.causes == (DriftCause.RATIO,)
