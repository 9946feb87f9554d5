"""Make the records of a month of one motor, to try `mcc follow` on.

python examples/make_month_of_records.py FOLDER

One record every four hours of the motor of examples/motor.toml. Its load lies between 15 and 90 % of the
rated one, its supply wanders, and its relay's channels are some tenths of a percent off. After twenty days
0.6 % of the turns of phase b are shorted, and 0.05 % more every day. The physics are the simulator's own,
which share nothing with what judges them.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from core.machines.motor_file.reader import read_motor
from core.recordings import Channel, Quantity, Recording, comtrade
from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply, SupplyWander

HERE = Path(__file__).parent
SAMPLE_RATE_HZ, DURATION_S = 4_000.0, 0.3
FULL_SCALE_A, FULL_SCALE_V = 80.0, 700.0
BEGUN_NS = 1_772_323_200 * NANOSECONDS_PER_SECOND
DAYS, EVERY_S = 30, 4 * 3600
LOADS = (0.15, 0.9)
PHASE_B, FAULTY_AFTER_DAYS = 1, 20.0
STEP, GROWTH_A_DAY = 0.006, 0.0005
GAIN_ERRORS = (-0.003, 0.002, 0.001, 0.004, -0.002, 0.003)


def records() -> Iterator[Recording]:
    """Yield the records of the month."""
    motor = read_motor(HERE / "motor.toml")
    plate = motor.nameplate
    begins_s, ends_s = FAULTY_AFTER_DAYS * SECONDS_PER_DAY, float(DAYS * SECONDS_PER_DAY)
    fault = FaultCourse(
        PHASE_B,
        ((begins_s - 1.0, 0.0), (begins_s, STEP), (ends_s, STEP + GROWTH_A_DAY * (DAYS - FAULTY_AFTER_DAYS))),
    )
    supply = Supply(
        plate.rated_voltage_V,
        plate.rated_frequency_Hz,
        unbalance=0.004,
        wander=SupplyWander(voltage=0.01, unbalance=0.002, zero_sequence=0.001),
    )
    sensors = Sensors(FULL_SCALE_A, FULL_SCALE_V, GAIN_ERRORS, noise=0.002, current_delay_s=40e-6)
    channels = (
        *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE_A) for x in "abc"),
        *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE_V) for x in "abc"),
    )
    rng = np.random.default_rng(30)
    for at_s in range(0, DAYS * SECONDS_PER_DAY, EVERY_S):
        plant = MotorPlant(motor, supply, Load(rng.uniform(*LOADS)), sensors, fault, seed=at_s)
        yield Recording(
            plant.window(float(at_s), DURATION_S, SAMPLE_RATE_HZ),
            SAMPLE_RATE_HZ,
            BEGUN_NS + at_s * NANOSECONDS_PER_SECOND,
            channels,
            nominal_frequency_hz=plate.rated_frequency_Hz,
        )


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for number, record in enumerate(records(), start=1):
        comtrade.write(folder / f"HR_{number:04d}.CFG", record)
    print(f"{folder}: {number} records")


if __name__ == "__main__":
    main()
