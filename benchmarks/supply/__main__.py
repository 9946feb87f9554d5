"""Measure figures of supply and heat, and write docs/evidence/supply.md: python -m benchmarks.supply."""

import argparse
from pathlib import Path

from benchmarks.reporting import Section, write_sections
from benchmarks.supply import accuracy, relay, speed, winding

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "supply.md"
SUBJECTS = {"accuracy": accuracy, "relay": relay, "winding": winding, "speed": speed}
PREAMBLE = """\
# Supply and heat

Written by `python -m benchmarks.supply`; each section names the command that repeats it. What is measured is
defined in [Supply](../reference/supply.md) and in [Load and heat](../reference/load.md).
"""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.supply", description=__doc__)
    parser.add_argument("--subject", choices=SUBJECTS, action="append")
    parser.add_argument("--page", type=Path, default=PAGE)
    arguments = parser.parse_args()
    for name in arguments.subject or SUBJECTS:
        subject = SUBJECTS[name]
        title = (subject.__doc__ or "").splitlines()[0].rstrip(".")
        command = f"python -m benchmarks.supply --subject {name}"
        section = Section(name, title, command, tuple(subject.measure()))
        print(section.text())
        write_sections(arguments.page, PREAMBLE, [*SUBJECTS], [section])


if __name__ == "__main__":
    main()
