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

from benchmarks.condition.marks import Mark, marks_table, summary
from benchmarks.reporting import with_tables_as_files

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "evidence" / "condition.md"

TITLE = "# How well a motor is judged over time"

ABOUT = """\
Asked: when a motor's recordings are judged one after the other, how often is the answer right? Is it
healthy, what has changed, since when, how much, how soon does it reach its limit? `python -m
benchmarks.condition` writes this page; each section names the command that repeats it. Large tables are
files in `data`.

**Seen**: a change was found, of whatever kind. **Called `fault`**: shorted turns above the limit, 0.5 % of
a phase. **Asked**: what a study of the method reached in a simulation of its own, and beyond that what the
service is to reach. **Found**: with its 95 % interval after Clopper and Pearson. **Met** compares the
estimate itself; other motors could turn a mark whose interval holds the figure asked. Of a range over
paths, the lowest rate is to reach its low end, the highest its high end.
"""

RECORDS = """\
## How the records are made

Phasors of three windings in phase variables with shorted turns, paths and joints, in star or delta
(`benchmarks/condition/circuit.py`), and not of the filter's equations; records through files and measured
recordings are samples in time. **Motors**: 0.8 to 400 kW, 50 or 60 Hz, files off by up to 10 %, deep bars,
saturation, windings that warm, loads that step, wander or cycle. **Channels**: gains and delays uniform in
the class that the file states, from 1 % and 50 us to 0.2 % and 10 us. **Supplies**: V2/V1 that wanders and
jumps by up to 4 %. **Noise** over V1: `real` 0.02 %, as measured motors repeat, and `harsh` 0.2 %.
**Levels** are equivalent ones, turns / (1 + path). **Delays** count records from the first with the change,
which is 1.
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
    texts = page_texts(sections, kept)
    _data_of(page).write_text(json.dumps(documents, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    lines = [
        line
        for name, text in texts.items()
        for line in with_tables_as_files(page, f"{page.stem}-{name}", text.split("\n"))
    ]
    page.write_text("\n".join(lines), encoding="utf-8")


def page_text(sections: Mapping[str, Section], measured: Mapping[str, Measured]) -> str:
    """Return the page with all its tables."""
    return "\n".join(page_texts(sections, measured).values())


def page_texts(sections: Mapping[str, Section], measured: Mapping[str, Measured]) -> dict[str, str]:
    """Return the parts of the page by their names: what is asked and found, then a section each.

    Sections that were measured on another code than the newest one are marked.
    """
    newest = max(measured.values(), key=lambda one: one.finished, default=None)
    code = "" if newest is None else newest.code
    overview = "\n".join([*_overview(sections, measured, code), ""])
    parts = {"top": "\n".join([f"{TITLE}\n", ABOUT, overview, RECORDS])}
    for subject, section in sections.items():
        parts[subject] = "\n".join([*section_lines(section, measured.get(subject), code), ""])
    return parts


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
    """Return how many figures of each section are met, and every one that falls short."""
    lines = ["## What is asked, and what was found", "", *_sizes(sections, measured, code), ""]
    for subject, section in sections.items():
        one = measured.get(subject)
        if one is None:
            lines.append(f"- {_link(section)}: **not measured**")
            continue
        judged, met, _ = summary(one.marks)
        short = "; ".join(_short(mark) for mark in one.marks if mark.met is False)
        lines.append(
            f"- {_link(section)}: {met} of {judged} met{'' if one.code == code else ' on **earlier code**'}"
            + (f". **Falls short**: {short}" if short else "")
        )
    return lines


def _short(mark: Mark) -> str:
    """Return what falls short, with its first estimate."""
    return f"{mark.what} ({mark.found.partition(' (')[0]})"


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
