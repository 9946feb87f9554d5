"""Parameters followed while motors run: python -m benchmarks.tracking [--quick] [--subject SUBJECT]."""

from pathlib import Path

from benchmarks.page_of_subjects import PageOfSubjects
from benchmarks.tracking import drifts, false_alarms, recorded

PAGE = Path("docs/evidence/tracking.md")
PREAMBLE = """# Parameters while the motor runs

What `core.tracking` finds of parameters that drift. Drifts and false alarms are measured on the motors of
the [condition](condition.md): 0.8 to 400 kW, solved by phasors of three windings, with files that are wrong
by up to 10 %, relays of four classes, loads and weather that vary, windings that warm up, a cage whose
resistance grows with frequency, and iron that saturates. `python -m benchmarks.tracking --subject recorded`
follows recordings of the simulator, whose physics shares nothing with the follower, through the examination
of each record.

No motor whose parameters drift was at hand: these figures rest on simulation.
"""
SUBJECTS = {
    "drifts": drifts.sections,
    "false-alarms": false_alarms.sections,
    "recorded": recorded.sections,
}

if __name__ == "__main__":
    PageOfSubjects(PAGE, PREAMBLE, SUBJECTS).measure(__doc__)
