"""Repeat the thesis's experiments and write docs/evidence/thesis.md with our figures beside the thesis's.

python -m benchmarks.thesis [--section functions|commissioning|diagnosis]...

Sections that are not run stay as they are; plots go to docs/evidence/images/thesis.
"""

import argparse
import os
from collections.abc import Iterator
from pathlib import Path

from benchmarks.reporting import Section, write_sections

DOCS = Path(__file__).parents[2] / "docs" / "evidence"

TITLES = {
    "functions": "Chapter 4: test functions",
    "commissioning": "Chapter 5: motor parameters from a start",
    "diagnosis": "Chapter 6: shorted turns from steady running",
}

PREAMBLE = """\
# The thesis's experiments, repeated

This page is written by `python -m benchmarks.thesis`; each section names the command that repeats it.
Figures of the thesis are as printed there, ours as measured. "The thesis" is the one on motor condition
monitoring with hyperbolic cross points that the nomenclature page names. Its motor is the 800 W machine of
its Table 3.2.
"""


def lines_of(subject: str, images: Path) -> Iterator[str]:
    """A section's lines. Each loads what it needs only when it is run."""
    if subject == "functions":
        from benchmarks.thesis.functions import lines

        yield from lines(images)
    elif subject == "commissioning":
        from benchmarks.thesis.commissioning import section

        # Its own heading is left out: the page has one for every section.
        yield from section(images=images).split("\n")[2:]
    else:
        from benchmarks.thesis.diagnosis import lines

        yield from lines(images)


def _processor_s() -> float:
    """Time of all cores together so far, that of finished child processes included [s]."""
    return sum(os.times()[:4])


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.thesis", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--section", choices=TITLES, action="append")
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder of the page and its images")
    arguments = parser.parse_args()
    images = arguments.docs / "images" / "thesis"
    for subject in arguments.section or TITLES:
        begun = _processor_s()
        lines = (
            *lines_of(subject, images),
            "",
            f"This section took {_processor_s() - begun:.0f} s of one core.",
        )
        section = Section(subject, TITLES[subject], f"python -m benchmarks.thesis --section {subject}", lines)
        write_sections(arguments.docs / "thesis.md", PREAMBLE, tuple(TITLES), [section])


if __name__ == "__main__":
    main()
