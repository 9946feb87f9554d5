"""Parameters followed while motors run: python -m benchmarks.tracking [--quick] [--subject SUBJECT]."""

import argparse
import os
from concurrent.futures import Executor, ProcessPoolExecutor
from pathlib import Path

from benchmarks.reporting import Section, write_sections
from benchmarks.tracking import drifts, false_alarms, recorded

PAGE = Path("docs/evidence/tracking.md")
PREAMBLE = """# Parameters while the motor runs

What `core.tracking` finds of parameters that drift. Drifts and false alarms are measured on the motors of
the [condition](condition.md): 0.8 to 400 kW, solved by phasors of three windings, with files that are wrong
by up to 10 %, relays of four classes, loads and weather that vary, windings that warm up, a cage whose
resistance grows with frequency, and iron that saturates. The last section follows recordings of the
simulator, whose physics shares nothing with the follower, through the examination of each record.

No motor whose parameters drift was at hand: these figures rest on simulation.
"""
SUBJECTS = {
    "drifts": drifts.sections,
    "false-alarms": false_alarms.sections,
    "recorded": recorded.sections,
}


def main() -> None:
    """Measure the subjects, and put them into the page unless they are quick ones."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few cases, printed and not written")
    parser.add_argument("--subject", choices=SUBJECTS, action="append", help="only this one")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    sections: list[Section] = []
    with ProcessPoolExecutor(options.workers) as pool:
        for name in options.subject or SUBJECTS:
            sections += _of(name, pool, quick=options.quick)
    if options.quick:
        print("\n".join(section.text() for section in sections))
    else:
        write_sections(PAGE, PREAMBLE, list(SUBJECTS), sections)


def _of(name: str, pool: Executor, *, quick: bool) -> list[Section]:
    return SUBJECTS[name](pool, quick=quick)


if __name__ == "__main__":
    main()
