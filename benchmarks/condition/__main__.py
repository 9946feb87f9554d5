"""Measure how motors are judged over time and write docs/evidence/condition.md.

python -m benchmarks.condition [SUBJECT]... [--quick] [--share S] [--data FOLDER] [--page FILE]
python -m benchmarks.condition --write-page

Every subject writes its own section with the command that repeats it; sections of subjects that are not
measured stay, and the page says at which size they were, and which of them on earlier code. With --quick the
sections are printed, and written only where a page is given. All random numbers come from fixed seeds.
"""

import argparse
import os
import sys
from concurrent.futures import Executor
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter

from benchmarks.condition.effort import effort_of
from benchmarks.condition.marks import Mark
from benchmarks.condition.page import PAGE, Measured, judged_code, section_lines, write_page
from benchmarks.condition.subjects import MILL, SECTIONS, SUBJECTS, Subject, mill_subject
from benchmarks.processes import worker_processes


def main() -> None:
    """Measure the chosen subjects and put their sections into the page."""
    chosen = _parse()
    # Matrices are small here: threads of the linear algebra library would only fight over the cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    share = 0.0 if chosen.quick else chosen.share
    page = chosen.page or (None if chosen.quick else PAGE)
    if chosen.write_page:
        write_page(chosen.page or PAGE, SECTIONS, {})
        return
    subjects = dict(SUBJECTS)
    if chosen.data is not None:
        subjects[MILL] = mill_subject(chosen.data)
    names = [name for name in SECTIONS if name in (chosen.subjects or subjects)]
    code = judged_code()
    with worker_processes(chosen.processes) as pool:
        for number, name in enumerate(names, start=1):
            _say(_begin_text(subjects[name], name, share, number, len(names)))
            measured = _measure(subjects[name], _command(name, share), share, code, pool)
            _say(f"{name}: {measured.seconds:.0f} s")
            if page is None:
                print("\n".join([*section_lines(SECTIONS[name], measured, measured.code), ""]), flush=True)
            else:
                write_page(page, SECTIONS, {name: measured})


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.condition", description=(__doc__ or "").splitlines()[0]
    )
    order = ", ".join(SECTIONS)
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=f"all of {order}")
    parser.add_argument(
        "--data", type=Path, help=f"folder that holds mill_vi_8khz, the measured recordings of {MILL}"
    )
    parser.add_argument("--quick", action="store_true", help="few motors: for a first look; printed")
    parser.add_argument("--share", type=float, default=1.0, help="share of the motors, 0 to 1")
    parser.add_argument("--page", type=Path, help=f"the page to write ({PAGE.name}; with --quick none)")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument(
        "--write-page", action="store_true", help="write the page again from what was measured before"
    )
    chosen = parser.parse_args()
    unknown = sorted(set(chosen.subjects) - set(SECTIONS))
    if unknown:
        parser.error(f"no subject {', '.join(unknown)}: choose among {order}")
    if not 0.0 < chosen.share <= 1.0:
        parser.error(f"--share {chosen.share:g} is not above 0 and at most 1")
    if MILL in chosen.subjects and chosen.data is None:
        parser.error(f"{MILL} needs --data FOLDER, the folder that holds mill_vi_8khz")
    return chosen


def _measure(subject: Subject, command: str, share: float, code: str, pool: Executor) -> Measured:
    begun = perf_counter()
    found = list(subject.measure(effort_of(share), pool))
    return Measured(
        command=command,
        share=share,
        finished=f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        seconds=perf_counter() - begun,
        code=code,
        marks=tuple(one for one in found if isinstance(one, Mark)),
        lines=tuple(one for one in found if isinstance(one, str)),
    )


def _command(name: str, share: float) -> str:
    options = {0.0: " --quick", 1.0: ""}.get(share, f" --share {share:g}")
    return f"python -m benchmarks.condition {name}{options}{' --data FOLDER' if name == MILL else ''}"


def _begin_text(subject: Subject, name: str, share: float, number: int, of: int) -> str:
    minutes = f", about {max(1.0, share * subject.minutes):.0f} min on two cores" if share else ""
    return f"{name}: {number} of {of}{minutes}"


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
