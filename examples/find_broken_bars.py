"""Look for broken rotor bars: python examples/find_broken_bars.py [RECORD.CFG MOTOR.toml]

Without files a motor is simulated for ten seconds, once whole and once with one of 28 bars broken.
"""

import sys
from pathlib import Path

from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from core.recordings import Channel, Quantity, Recording, read
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply

HERE = Path(__file__).parent
DURATION_S, SAMPLE_RATE_HZ = 10.0, 5_000.0
FULL_SCALE_A, FULL_SCALE_V = 200.0, 700.0


def simulated(motor: Motor, broken_share: float) -> Recording:
    """Currents and voltages of a motor at 60 % load."""
    plate = motor.nameplate
    plant = MotorPlant(
        motor,
        Supply(plate.rated_voltage_V, plate.rated_frequency_Hz, unbalance=0.003),
        Load(0.6),
        Sensors(FULL_SCALE_A, FULL_SCALE_V, noise=0.002),
        broken_bars=broken_share,
    )
    channels = (
        *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE_A) for x in "abc"),
        *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE_V) for x in "abc"),
    )
    return Recording(plant.window(0.0, DURATION_S, SAMPLE_RATE_HZ), SAMPLE_RATE_HZ, 0, channels)


def look_at(recording: Recording, motor: Motor) -> None:
    """Check, diagnose and examine a recording, and print what its rotor is like."""
    acceptance = accept(recording, motor)
    if acceptance.accepted is None:
        sys.exit("; ".join(finding.message for finding in acceptance.quality if not finding.passed))
    accepted = acceptance.accepted
    rotor = examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(acceptance))
    print(f"{rotor.state}: " + "; ".join(rotor.reasons))
    if rotor.severity_dB is not None and rotor.severity_dB_ci95 is not None:
        low, high = rotor.severity_dB_ci95
        print(
            f"  severity {rotor.severity_dB:.1f} dB (95 % interval {low:.1f} to {high:.1f} dB, "
            f"detection limit {rotor.detection_limit_dB:.1f} dB), sidebands {rotor.lower_sideband_dB:.1f} "
            f"and {rotor.upper_sideband_dB:.1f} dB, slip {rotor.slip:.2%}"
        )


def main() -> None:
    """Examine a recording, or two simulated ones."""
    if len(sys.argv) == 3:
        look_at(read(Path(sys.argv[1])), read_motor(sys.argv[2]))
    elif len(sys.argv) == 1:
        motor = read_motor(HERE / "motor.toml")
        for broken_share in (0.0, 1.0 / 28.0):
            look_at(simulated(motor, broken_share), motor)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
