"""Follow a motor's parameters over its records: python examples/follow_parameters.py [MOTOR.toml RECORD...]

Without files a motor is simulated: 40 records at changing loads, and 12 more after somebody has set a wrong
ratio of the current transformers.
"""

import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from core.condition.measuring.observing import observe
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from core.recordings import Channel, Quantity, Recording, read
from core.tracking.follower import Follower
from core.tracking.telling import tracked_parameters
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

HERE = Path(__file__).parent
LENGTH_S, SAMPLE_RATE_HZ, HOUR_NS = 0.32, 4_000.0, 3_600_000_000_000
FULL_SCALE_A, FULL_SCALE_V = 200.0, 700.0
LOADS = (0.3, 0.9, 0.6, 0.45, 0.75)
RIGHT, WRONG, WRONG_BY = 40, 12, -0.04


def simulated(motor: Motor, number: int) -> Recording:
    """A record of the motor, one an hour."""
    plate, gain = motor.nameplate, WRONG_BY if number >= RIGHT else 0.0
    plant = MotorPlant(
        motor,
        Supply(
            plate.rated_voltage_V,
            plate.rated_frequency_Hz,
            unbalance=0.004,
            unbalance_angle_rad=2.4 * number,
        ),
        Load(LOADS[number % len(LOADS)]),
        Sensors(FULL_SCALE_A, FULL_SCALE_V, gain_errors=(gain, gain, gain, 0.0, 0.0, 0.0), noise=0.001),
        seed=number,
    )
    channels = (
        *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE_A) for x in "abc"),
        *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE_V) for x in "abc"),
    )
    samples = plant.window(10.0, LENGTH_S, SAMPLE_RATE_HZ, step_rate_hz=8_000.0)
    recording = Recording(samples, SAMPLE_RATE_HZ, 0, channels)
    return replace(recording, start_time_ns=number * HOUR_NS)


def follow(motor: Motor, recordings: Iterable[Recording]) -> None:
    """Follow recordings in the order of their times, and print what they tell of the parameters."""
    seen = [one for one in (observe(recording, motor) for recording in recordings) if one is not None]
    follower = Follower(motor)
    for observation in sorted(seen, key=lambda one: one.time_ns):
        follower.follow(observation)
    found = tracked_parameters(follower)
    print(f"{found.state} after {found.records} records: {'; '.join(found.reasons)}")
    for one in found.parameters:
        low, high = one.change_ci95
        print(f"  {one.name.words}: {one.state}, change {low:+.1%} to {high:+.1%}. {'; '.join(one.reasons)}")


def _simulated_records(motor: Motor) -> Iterator[Recording]:
    return (simulated(motor, number) for number in range(RIGHT + WRONG))


def main() -> None:
    """Follow recordings, or simulated ones."""
    if len(sys.argv) > 2:
        follow(read_motor(sys.argv[1]), (read(Path(name)) for name in sys.argv[2:]))
    elif len(sys.argv) == 1:
        motor = read_motor(HERE / "motor.toml")
        follow(motor, _simulated_records(motor))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
