"""Broken rotor bars: python -m benchmarks.rotor [--quick] [--subject SUBJECT] [--data FOLDER]."""

from pathlib import Path

from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.rotor import (
    beside_turns,
    detection,
    false_alarms,
    leakage,
    measured,
    one_phase,
    sideband_figure,
    speed,
)

PAGE = Path("docs/evidence/rotor.md")
PREAMBLE = """# Broken rotor bars

What one record tells of the rotor's cage, on simulated motors of 0.8, 7.5 and 37 kW. Their cages have 28
bars and rings with physics of their own (`ied_sim.motor.cage`). Every operation draws its voltage,
frequency, unbalance up to 2 %, harmonics up to 3 %, noise up to 1 % of rated and an inertia of one to six
times that of the motor. The examination knows every parameter with an error of up to 10 %, the inertia
within half to twice, and relays with gain errors up to 1 %. A load that swings does so by 1 to 10 % of the
rated torque. States and figures are those of `core.rotor`: severity is the asymmetry of the rotor's
resistance. Fault means that its 95 % interval lies above -36 dB, watch that the severity lies above -42 dB.

Unsupported counts what the quality gate refuses, too.

No motor with a broken bar was at hand: what is said of them rests on simulation.
"""
SUBJECTS = {
    "detection": detection.sections,
    "beside-turns": beside_turns.sections,
    "false-alarms": false_alarms.sections,
    "leakage": leakage.sections,
    "one-phase": one_phase.sections,
    "sidebands": sideband_figure.sections,
    "speed": speed.sections,
}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS, measured.sections).measure(__doc__)
