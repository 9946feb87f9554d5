"""Make RUNNING.CFG, a recording of a running motor to try `mcc diagnose` on.

python examples/make_running_record.py [FOLDER]      (without: beside this file)

The motor of examples/motor.toml with 5 % of the turns of phase b shorted, at 65 % of the rated torque. The
physics are the simulator's own: windings in phase variables, which share nothing with the fitted model.
"""

import sys
from pathlib import Path

from core.machines.motor_file.reader import read_motor
from core.recordings import Channel, Quantity, Recording, comtrade
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

HERE = Path(__file__).parent
SAMPLE_RATE_HZ = 5_000.0
DURATION_S, BEFORE_S = 0.5, 0.1
FULL_SCALE_A, FULL_SCALE_V = 80.0, 700.0
PHASE_B, SHORTED_TURNS = 1, 0.05
STARTED_NS = 1_767_603_600_000_000_000
"""An hour after the start in START.CFG."""


def running_record() -> Recording:
    """The recording: IA IB IC and VA VB VC of half a second."""
    motor = read_motor(HERE / "motor.toml")
    plate = motor.nameplate
    plant = MotorPlant(
        motor,
        Supply(plate.rated_voltage_V, plate.rated_frequency_Hz, unbalance=0.003),
        Load(0.65),
        Sensors(
            FULL_SCALE_A,
            FULL_SCALE_V,
            gain_errors=(-0.0008, 0.0005, 0.0003, 0.0006, -0.0004, 0.0007),
            noise=0.002,
            current_delay_s=40e-6,
        ),
        FaultCourse(PHASE_B, ((0.0, SHORTED_TURNS),)),
        seed=710,
    )
    return Recording(
        plant.window(0.0, DURATION_S, SAMPLE_RATE_HZ),
        SAMPLE_RATE_HZ,
        STARTED_NS,
        (
            *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE_A) for x in "abc"),
            *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE_V) for x in "abc"),
        ),
        trigger_index=round(BEFORE_S * SAMPLE_RATE_HZ),
        nominal_frequency_hz=plate.rated_frequency_Hz,
    )


def main() -> None:
    if any(word.startswith("-") for word in sys.argv[1:]):
        sys.exit(__doc__)
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    print(comtrade.write(folder / "RUNNING.CFG", running_record()))


if __name__ == "__main__":
    main()
