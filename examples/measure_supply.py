"""Measure the supply of a motor in a recording: python examples/measure_supply.py [RECORD.CFG MOTOR.toml]"""

import sys
from pathlib import Path

from core.machines.motor_file.reader import read_motor
from core.recordings import read
from core.supply.measuring import measure_supply

HERE = Path(__file__).parent
MOST_HVF = 0.02
"""IEC 60034-1, 7.2.1.1, for motors that are not of design N."""


def main() -> None:
    given = [Path(argument) for argument in sys.argv[1:]]
    record, motor_file = given or (HERE / "RUNNING.CFG", HERE / "motor.toml")
    found = measure_supply(read(record), read_motor(motor_file))
    voltages = ", ".join(f"{voltage_V:.1f}" for voltage_V in found.line_voltages_V)
    print(f"{found.frequency_hz:.3f} Hz, line voltages {voltages} V ({found.voltage_deviation:+.2%})")
    left = "stop it" if found.derating is None else f"leaves {found.derating:.0%} of its power"
    nema = f"{found.voltage_unbalance_nema:.2%} (NEMA)"
    print(f"unbalance {found.voltage_unbalance_iec:.2%} (IEC), {nema}: {left}")
    compared = "within" if found.harmonic_voltage_factor <= MOST_HVF else "beyond"
    hvf = f"HVF {found.harmonic_voltage_factor:.4f}, {compared} the {MOST_HVF:g} of IEC 60034-1"
    print(f"THD {found.thd_voltage:.2%}, {hvf}")
    if found.line_currents_A is not None and found.active_power_W is not None:
        currents = ", ".join(f"{current_A:.2f}" for current_A in found.line_currents_A)
        print(f"currents {currents} A, I2/I1 {found.current_unbalance:.2%}, {found.active_power_W:.0f} W")
    for reason in found.reasons:
        print(f"  {reason}")


if __name__ == "__main__":
    main()
