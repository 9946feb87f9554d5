"""Measure our optimisers against others' in one run and write docs/evidence/optimisers.md.

python -m benchmarks.optimisers [--subject functions|motor|start] [--runs N] [--sgpp PYTHON]

--sgpp: an interpreter with pysgpp (it needs numpy below 2, so an environment of its own); without one, SG++
is left out and the page says so. NLopt and CMA-ES come with pip install -e '.[peers]'. The page is written
after every function or method: what a run has measured outlives it.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

from benchmarks.optimisers.functions import functions
from benchmarks.optimisers.motor import motor, start
from benchmarks.reporting import Section, write_sections

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "optimisers.md"
RUNS = {"functions": 30, "motor": 20, "start": 20}
"""Shifts of every function's box, and truths."""

TITLES = {
    "functions": "Test functions",
    "motor": "The motor's cost: steady running, four parameters",
    "start": "The motor's cost: a start, seven parameters",
}

PREAMBLE = """\
# The optimisers, ours and others'

Asked: how many evaluations does each optimiser need? `python -m benchmarks.optimisers` writes this page. A
run counts every evaluation, those of difference quotients too, and ends at 2,000. Tables have the
evaluations after which the best point is good enough: the median (`-`: fewer than half get there), and how
many runs do (in brackets).

**Ours**: the thesis's HCPA as Table 4.1 prints it; **HCPA, deep** (fineness 40, no exclusion, a quarter of
the points global); its genetic algorithm and pattern search; **multistart**
(`benchmarks/optimisers/multistart.py`: HCPA, then local refinement of the best separated points). The
product has the first as its methods `hcpa`, `genetic` and `pattern-search`; `hybrid` is HCPA with 60 points
and a refinement on phasors. It does not call multistart. `examples/search_a_function.py` shows how to call
HCPA. **Others'**: NLopt's DIRECT-L, scipy's direct, SHGO and dual annealing, CMA-ES with restarts (pycma),
SG++'s Ritter-Novak grid generator.

| median evaluations to the best fit of a motor | multistart | the same, by cost alone | best of the others |
| --- | --- | --- | --- |
| steady running, four parameters | 77 | 110 | 110 (SHGO) |
| a start, seven parameters | 89 | 436 | 308 (dual annealing) |

**Falls short.** Plain HCPA loses to DIRECT-L on all test functions but Mladineo's, where neither gets there
in half of the runs; on the motor's costs neither gets to 1 %, and HCPA ends farther off. Multistart misses
hardly any run, but on ten of eleven functions DIRECT-L or dual annealing needs fewer evaluations. Told no
more than they are, it is level with SHGO in steady running and behind dual annealing on a start.
"""


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.optimisers",
        description=__doc__,
        formatter_class=argparse.RawTextHelpFormatter,
    )
    parser.add_argument("--subject", choices=TITLES, action="append")
    parser.add_argument("--runs", type=int, help=f"shifts or truths of a subject; without: {RUNS}")
    parser.add_argument("--sgpp", metavar="PYTHON", help="an interpreter with pysgpp")
    parser.add_argument("--page", type=Path, default=PAGE)
    arguments = parser.parse_args()
    for subject in arguments.subject or TITLES:
        command = f"python -m benchmarks.optimisers --subject {subject}"
        command += f" --runs {arguments.runs}" if arguments.runs else ""
        command += " --sgpp PYTHON" if subject == "functions" and arguments.sgpp else ""
        for lines in _measured(subject, arguments.runs or RUNS[subject], arguments.sgpp):
            section = Section(subject, TITLES[subject], command, lines)
            write_sections(arguments.page, PREAMBLE, tuple(TITLES), [section])


def _measured(subject: str, runs: int, sgpp: str | None) -> Iterator[tuple[str, ...]]:
    """A section's lines so far, again and again as they grow."""
    if subject == "functions":
        return functions(runs, sgpp)
    return {"motor": motor, "start": start}[subject](runs)


if __name__ == "__main__":
    main()
