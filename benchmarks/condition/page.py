"""The page on the condition of a motor, written from what was measured.

What was measured is kept beside the page as JSON, so that a run of one section leaves the others as they
were, the page can be written again without a measurement, and it says of each section when, of how many
motors and on which code it was measured.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from benchmarks.condition.marks import HEADER, Mark, marks_table, summary
from benchmarks.reporting import table

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "evidence" / "condition.md"

TITLE = "# How well a motor is judged over time"

ABOUT = """\
A motor's recordings are judged one after the other: is it healthy, what has changed, since when, how much,
how soon does it reach its limit? This page tells how often the answer is right, of simulated motors, whose
truth is known, and of measured recordings. `python -m benchmarks.condition` writes it; each section names the
command that repeats it. Every figure is given as it was found, also where it falls short of what is asked.

**Seen** means that a change was found, of whatever kind. **Called `fault`** means that the motor's state was
`fault`: shorted turns above its limit, which is 0.5 % of a phase.

**Asked** is what a study of the method reached in a simulation of its own, and beyond that what the service
is to reach. **Found** is given with its 95 % interval after Clopper and Pearson. **Met** compares the
estimate as it is, without rounding, with the figure asked; where the interval holds that figure, other motors
could turn the mark. Of a range over paths, the lowest rate is to reach its low end, the highest its high end.
"""

RECORDS = """\
## How the records are made

**Records** are phasors in all sections but two: records through files and measured recordings are samples in
time. The phasors come from the machine's own equations and not from the filter's: three windings in phase
variables with shorted turns, a path's resistance and joints, solved with the star point or the delta
(`benchmarks/condition/circuit.py`). The tests hold them against the core's models and against circuits in
phase variables.

**Motors** have a rating of their own, 0.8 to 400 kW, star or delta, either sequence, 50 or 60 Hz; a file that
is off by up to 10 % in each figure unless said otherwise; windings that differ by themselves; a cage with
skin effect; inductance that saturates; windings that warm with the load; a load that is constant, steps,
wanders, is random or on a duty cycle.

**Channels** have gains and delays uniform in their class, which the motor's file states: one of four classes,
from 1 % and 50 us to 0.2 % and 10 us.

**Supplies** have a V2/V1 that wanders and jumps by up to 4 %; their voltage and frequency wander.

**Noise** is that of a channel's phasor from record to record over V1 (currents: over V1/|Z2|): `real` 0.02 %,
as measured motors repeat, and `harsh` 0.2 %.

**Levels** are equivalent ones, turns / (1 + path); `path` is the path's resistance over that of the turns.

**Delays** count records from the first with the change, which is 1.
"""


@dataclass(frozen=True, slots=True)
class Measured:
    """What a run measured of a section.

    share: of the full size; 0 of a first look.  finished: UTC.  seconds: how long it took.  code: fingerprint
    of the code that was judged.
    """

    command: str
    share: float
    finished: str
    seconds: float
    code: str
    marks: tuple[Mark, ...]
    lines: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        return {
            "command": self.command, "share": self.share, "finished": self.finished,
            "seconds": round(self.seconds), "code": self.code,
            "marks": [one.as_dict() for one in self.marks], "lines": list(self.lines),
        }  # fmt: skip

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> "Measured":
        return cls(
            **{
                **document,
                "marks": tuple(Mark.from_dict(one) for one in document["marks"]),
                "lines": tuple(document["lines"]),
            }
        )


@dataclass(frozen=True, slots=True)
class Section:
    """A section of the page: its title, and what is said before its tables, at a share of the full size."""

    title: str
    about: Callable[[float], Sequence[str]]


def judged_code() -> str:
    """Fingerprint of the code that judges motors: figures of another one may be others."""
    found = sha256()
    for path in sorted((ROOT / "core").rglob("*.py")):
        found.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()[:12]


def read_measured(page: Path) -> dict[str, Measured]:
    """Return what was measured of each section, by its subject; nothing where there is no such file."""
    path = _data_of(page)
    if not path.exists():
        return {}
    documents = json.loads(path.read_text(encoding="utf-8"))
    return {subject: Measured.from_dict(one) for subject, one in documents.items()}


def write_page(page: Path, sections: Mapping[str, Section], new: Mapping[str, Measured]) -> None:
    """Put what was measured beside what is there, and write the page."""
    measured = read_measured(page) | dict(new)
    kept = {subject: measured[subject] for subject in sections if subject in measured}
    documents = {subject: one.as_dict() for subject, one in kept.items()}
    text = page_text(sections, kept)
    _data_of(page).write_text(json.dumps(documents, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    page.write_text(text, encoding="utf-8")


def page_text(sections: Mapping[str, Section], measured: Mapping[str, Measured]) -> str:
    """Return the page: what is asked and found at the top, then a section each.

    Sections that were measured on another code than the newest one are marked.
    """
    newest = max(measured.values(), key=lambda one: one.finished, default=None)
    code = "" if newest is None else newest.code
    parts = [f"{TITLE}\n", ABOUT, "\n".join([*_overview(sections, measured, code), ""]), RECORDS]
    for subject, section in sections.items():
        parts.append("\n".join([*section_lines(section, measured.get(subject), code), ""]))
    return "\n".join(parts)


def section_lines(section: Section, measured: Measured | None, code: str) -> list[str]:
    """Return one section, also of a subject that was not measured."""
    head = [f"## {section.title}", ""]
    if measured is None:
        return [*head, "**Not measured.**"]
    head += [f"`{measured.command}`", "", f"{_when(measured)}.", ""]
    if measured.code != code:
        head += ["**Measured on earlier code** than the newest section: its figures may be others now.", ""]
    marks = [*marks_table(measured.marks), ""] if measured.marks else ["No figure is asked for.", ""]
    return [*head, *section.about(measured.share), "", *marks, *measured.lines]


def _overview(sections: Mapping[str, Section], measured: Mapping[str, Measured], code: str) -> list[str]:
    """Return how many figures are met, a row a section, and every one that falls short."""
    rows, short = [], []
    for subject, section in sections.items():
        one = measured.get(subject)
        if one is None:
            rows.append([_link(section), "-", "-", "-", "**not measured**"])
            continue
        note = "" if one.code == code else "; **earlier code**"
        rows.append([_link(section), *summary(one.marks), _when(one) + note])
        short += [[_link(section), *mark.row()[:-1]] for mark in one.marks if mark.met is False]
    lines = ["## What is asked, and what was found", "", *_sizes(sections, measured, code), ""]
    lines += table(["section", "figures judged", "met", "fall short", "measured"], rows)
    if short:
        lines += ["", "What **falls short**:", "", *table(["section", *HEADER[:-1]], short)]
    elif any(one.marks for one in measured.values()):
        lines += ["", "Nothing that was judged falls short."]
    return lines


def _sizes(sections: Mapping[str, Section], measured: Mapping[str, Measured], code: str) -> list[str]:
    """Return one sentence on how much was measured, and on which code."""
    sizes = {_size(one.share) for one in measured.values()}
    missing = len(sections) - len(measured)
    every = "All sections are" if not missing else f"{len(measured)} of {len(sections)} sections are"
    if len(sizes) == 1:
        text = f"{every} measured at {sizes.pop()}"
    else:
        text = f"{every} measured, at different sizes"
    older = sum(one.code != code for one in measured.values())
    return [f"{text}, {'on the same code' if not older else f'**{older} of them on earlier code**'}."]


def _when(measured: Measured) -> str:
    minutes = max(1, round(measured.seconds / 60.0))
    size = _size(measured.share)
    return f"{size[0].upper()}{size[1:]}, {measured.finished}, {minutes} min"


def _size(share: float) -> str:
    if share == 0.0:
        return "the size of a first look (`--quick`)"
    return "full size" if share == 1.0 else f"{share:.0%} of the full size"


def _link(section: Section) -> str:
    anchor = "".join(one for one in section.title.lower().replace(" ", "-") if one.isalnum() or one == "-")
    return f"[{section.title}](#{anchor})"


def _data_of(page: Path) -> Path:
    return page.with_suffix(".json")
