"""Motors with a wound rotor, simulated: python -m benchmarks.wound_rotor [--quick] [--subject SUBJECT]."""

from pathlib import Path

from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.wound_rotor import false_alarms, rings, stator, winding

PAGE = Path("docs/evidence/other-machines.md")
PREAMBLE = """# Other machines: the wound rotor

What one record tells of a motor with a wound rotor, on two simulated motors: a hoist of 37 kW at 400 V and a
mill of 500 kW at 6 kV. The simulator's rotor is three coils with a resistance of their own each
(`ied_sim.motor.slip_rings`). Every record draws unbalance up to 1 %, noise up to 0.5 % of rated, gain errors
up to 0.5 % and the rotor's angle; the examination knows every parameter with an error of up to 10 %. No
record of a real motor with slip rings was at hand: these figures rest on simulation. What follows from which
measurement is in [adding a machine](../explanation/adding-a-machine.md#what-a-record-tells).
"""
SUBJECTS = {
    "stator": stator.sections,
    "winding": winding.sections,
    "rings": rings.sections,
    "false-alarms": false_alarms.sections,
}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS).measure(__doc__)
