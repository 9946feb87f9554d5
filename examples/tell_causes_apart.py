"""Tell which cause a recording shows: python examples/tell_causes_apart.py [RECORD.CFG MOTOR.toml]

Without files a motor is simulated for five seconds: sound, with shorted turns, with a bad joint, with a load
that swings, and with two causes at once.
"""

import sys
from dataclasses import replace
from pathlib import Path

from core.findings.examining import examine
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from core.recordings import Channel, Quantity, Recording, read
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

HERE = Path(__file__).parent
DURATION_S, SAMPLE_RATE_HZ = 5.0, 4_000.0
FULL_SCALE_A, FULL_SCALE_V = 200.0, 700.0
SOME_TIME_NS = 1_790_000_000_000_000_000


def recorded(plant: MotorPlant) -> Recording:
    """What a relay records of a motor."""
    channels = (
        *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE_A) for x in "abc"),
        *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE_V) for x in "abc"),
    )
    samples = plant.window(0.0, DURATION_S, SAMPLE_RATE_HZ)
    return Recording(samples, SAMPLE_RATE_HZ, SOME_TIME_NS, channels)


def simulated(motor: Motor) -> dict[str, MotorPlant]:
    """Motors at 80 % load, by what is wrong with them."""
    plate = motor.nameplate
    sound = MotorPlant(
        motor,
        Supply(plate.rated_voltage_V, plate.rated_frequency_Hz, unbalance=0.003),
        Load(0.8),
        Sensors(FULL_SCALE_A, FULL_SCALE_V, noise=0.002),
    )
    turns = FaultCourse(1, ((0.0, 0.05),))
    ohms = 1.5 * motor.parameters.stator_resistance_ohm
    swings = Load(0.8, pulsations=(Pulsation(0.06, frequency_Hz=7.0),))
    return {
        "sound": sound,
        "turns of phase b shorted": replace(sound, fault=turns),
        "a bad joint in phase c": replace(sound, joint=JointCourse(2, ((0.0, ohms),))),
        "a load that swings": replace(sound, load=swings),
        "shorted turns and a broken bar": replace(sound, fault=turns, broken_bars=1.0 / 28.0),
    }


def look_at(recording: Recording, motor: Motor) -> None:
    """Print the answer, the likelihoods, and what would tell where it is open."""
    answer = examine(recording, motor).classification
    print(f"{answer.words} ({answer.answer.probability:.0%})")
    for one in answer.likelihoods[:3]:
        print(f"  {one.cause} {one.probability:.1%}: {one.figure}")
    for pair in answer.not_told_apart:
        print(f"  {' or '.join(pair.one.names)}, or {' or '.join(pair.other.names)}? {pair.tests[0]}")


def main() -> None:
    """Look at a recording, or at simulated ones."""
    if len(sys.argv) == 3:
        look_at(read(Path(sys.argv[1])), read_motor(sys.argv[2]))
    elif len(sys.argv) == 1:
        motor = read_motor(HERE / "motor.toml")
        for name, plant in simulated(motor).items():
            print(f"In truth: {name}")
            look_at(recorded(plant), motor)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
