"""The page of the figures: the catalogue as a table."""

from collections.abc import Iterator

from core.quantities import QUANTITIES, Subject
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "reference" / "quantities.md"
PREAMBLE = """# Figures of a record

Every figure that is followed over time, as `core/quantities/catalogue.py` declares it; `make docs` writes the
page. The names are those of the columns of a [trend's file](../how-to/exports.md). Those with a trend are
what `mcc trend --quantity` and `GET /api/v1/motors/{name}/trend?quantity=` take; the others stand beside
them.
"""
HEADINGS = {
    Subject.STATOR: "The stator winding and the load, by the record itself",
    Subject.CONDITION: "The stator's condition, from all records so far",
    Subject.ROTOR: "The rotor",
    Subject.AIR_GAP: "The air gap",
    Subject.LOAD: "Swings of the load",
    Subject.SUPPLY: "The supply",
    Subject.LOSSES: "Losses and efficiency",
    Subject.PARAMETERS: "Parameters of the machine, from all records so far",
}


def page() -> str:
    """Return the page."""
    return "\n".join([PREAMBLE, *(line for subject in Subject for line in _section(subject))])


def _section(subject: Subject) -> Iterator[str]:
    yield f"## {HEADINGS[subject]}\n"
    yield "| Name | Unit | Meaning | Trend |"
    yield "|---|---|---|---|"
    for one in QUANTITIES:
        if one.subject is subject:
            meaning = one.meaning.replace("|", "\\|")
            trend = "yes" if one.is_trended else f"beside `{one.of}`" if one.of else ""
            yield f"| `{one.name}` | {one.unit} | {meaning} | {trend} |"
    yield ""


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), encoding="utf-8")
