"""Make START.CFG, a recorded start to try `mcc commission` on.

python examples/make_start_record.py [FOLDER]      (without: beside this file)

The motor of examples/motor.toml from the simulator's own physics (windings in phase variables), which share
nothing with the models that are fitted: a direct start at 60 % of the rated torque, with a relay's noise,
ratio errors and channel delay. What `mcc commission` finds can be held against motor.toml.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.machines.motor_file.reader import read_motor
from core.recordings import Channel, Quantity, Recording, comtrade
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

HERE = Path(__file__).parent
SAMPLE_RATE_HZ = 5_000.0
BEFORE_S, AFTER_S = 0.05, 0.55
CURRENT_DELAY_S = 40e-6
TRUE_RATE_HZ = 25_000.0
"""Of the simulated currents: a multiple of the recorder's rate and of 1 / CURRENT_DELAY_S."""
FULL_SCALE_A, FULL_SCALE_V = 250.0, 700.0
SWITCHED_ON_NS = 1_767_600_000_000_000_000
"""A Monday morning in January 2026, UTC."""


def start_record() -> Recording:
    """The recording: IA IB IC and VA VB VC from before the contactor closes until the motor has run up."""
    motor = read_motor(HERE / "motor.toml")
    sensors = Sensors(
        FULL_SCALE_A,
        FULL_SCALE_V,
        gain_errors=(-0.0008, 0.0005, 0.0003, 0.0006, -0.0004, 0.0007),
        noise=0.002,
    )
    plate = motor.nameplate
    supply = Supply(plate.rated_voltage_V, plate.rated_frequency_Hz, unbalance=0.003)
    plant = MotorPlant(motor, supply, Load(0.6), sensors)
    switched_on_s = 0.0043
    operation = plant.start_up(switched_on_s, AFTER_S, TRUE_RATE_HZ)
    every, late = round(TRUE_RATE_HZ / SAMPLE_RATE_HZ), round(CURRENT_DELAY_S * TRUE_RATE_HZ)
    currents = np.pad(operation.currents_A, ((0, 0), (late, 0)))[:, :-late:every]
    voltages = operation.voltages_V[:, ::every]
    before = round(BEFORE_S * SAMPLE_RATE_HZ)
    true = np.pad(np.vstack([currents, voltages]), ((0, 0), (before, 0)))
    samples = sensors.measure(true, plant.rated_values, np.random.default_rng(710))
    return Recording(
        samples,
        SAMPLE_RATE_HZ,
        SWITCHED_ON_NS - round(BEFORE_S * NANOSECONDS_PER_SECOND),
        _channels(),
        trigger_index=before,
        nominal_frequency_hz=plate.rated_frequency_Hz,
    )


def _channels() -> tuple[Channel, ...]:
    current = Channel("IA", Quantity.CURRENT, "a", "A", FULL_SCALE_A)
    voltage = Channel("VA", Quantity.PHASE_VOLTAGE, "a", "V", FULL_SCALE_V)
    return tuple(
        replace(one, name=one.name[0] + phase.upper(), phase=phase)
        for one in (current, voltage)
        for phase in "abc"
    )


def main() -> None:
    if any(word.startswith("-") for word in sys.argv[1:]):
        sys.exit(__doc__)
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    print(comtrade.write(folder / "START.CFG", start_record()))


if __name__ == "__main__":
    main()
