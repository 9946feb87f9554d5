"""What the evidence page says of figures that are asked for."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.condition.marks import (
    Mark,
    at_least,
    at_most,
    below,
    figure_at_most,
    marks_table,
    median_at_most,
    range_reached,
)
from benchmarks.condition.page import PAGE, Measured, Section, page_text, read_measured, write_page
from benchmarks.condition.subjects import SECTIONS as SECTIONS_OF_THE_PAGE

SHORT, MET = "**falls short**", "met"
SECTIONS = {
    "one": Section("Shorted turns found", lambda share: [f"{200 * share:.0f} motors a row."]),
    "two": Section("False alarms", lambda _: ["Healthy motors."]),
}


def measured(*marks: Mark, share: float = 1.0, code: str = "this", at: str = "03:04") -> Measured:
    finished = f"2026-01-02 {at} UTC"
    return Measured("python -m benchmarks", share, finished, 61.0, code, marks, ("| a table |",))


@pytest.mark.parametrize(
    ("mark", "verdict"),
    [
        (at_least("seen", 97, 100, 0.97), MET),
        (at_least("seen", 96, 100, 0.97), SHORT),
        (at_least("seen", 999, 1_000, 1.0), SHORT),
        (at_least("seen", 0, 0, 1.0), "not judged"),
        (at_most("called", 7, 100, 0.07), MET),
        (at_most("called", 1, 100, 0.0), SHORT),
        (below("watch", 1, 100, 0.01), SHORT),
        (below("watch", 99, 10_000, 0.01), MET),
        (figure_at_most("time", 100.1, 100.0, "us"), SHORT),
        (figure_at_most("time", 99.9, 100.0, "us"), MET),
        (median_at_most("delay", np.array([3.0, 3.0, 90.0]), 4.0), MET),
        (median_at_most("delay", np.array([3.0, 4.0, 90.0]), 4.0), SHORT),
        (median_at_most("delay", np.array([]), 4.0), "not judged"),
        (range_reached("seen", {"path 0": (94, 100), "path 1": (98, 100)}, 0.94, 0.98), MET),
        (range_reached("seen", {"path 0": (93, 100), "path 1": (99, 100)}, 0.94, 0.98), SHORT),
        (range_reached("seen", {"path 0": (96, 100), "path 1": (97, 100)}, 0.94, 0.98), SHORT),
    ],
)
def test_the_estimate_is_compared_with_what_is_asked(mark: Mark, verdict: str) -> None:
    assert marks_table([mark])[-1].endswith(f"| {verdict} |")


def test_a_rate_is_told_with_its_interval_and_never_rounded_up_to_all() -> None:
    assert at_least("seen", 9, 10, 0.97).found == "9 of 10 (90.00%; 55.50% to 99.75%)"
    found = range_reached("seen", {"path 0": (99_999, 100_000)}, 1.0, 1.0).found
    assert found.startswith("path 0: 99.99 % (99.9 to 99.9")


def test_what_falls_short_is_told_first() -> None:
    short, met = at_least("1 %: seen within 10", 96, 100, 0.97), at_most("alarms", 0, 50, 0.0)
    page = page_text(SECTIONS, {"one": measured(short, met), "two": measured(met)})

    top = page[: page.index("## How the records are made")]
    assert "All sections are measured at full size, on the same code." in top
    assert "- [Shorted turns found](#shorted-turns-found): 1 of 2 met. **Falls short**: 1 %: seen" in top
    assert "1 %: seen within 10 (96 of 100)" in top
    assert "- [False alarms](#false-alarms): 1 of 1 met\n" in top
    assert f"| 1 %: seen within 10 | at least 97 % | {short.found} | {SHORT} |" in page
    assert f"| alarms | none | {met.found} | {MET} |" in page
    assert "200 motors a row." in page


def test_what_was_not_measured_is_visible() -> None:
    page = page_text(SECTIONS, {"one": measured(at_most("alarms", 0, 50, 0.0), share=0.5)})

    assert "1 of 2 sections are measured at 50% of the full size, on the same code." in page
    assert "- [False alarms](#false-alarms): **not measured**" in page
    assert "## False alarms\n\n**Not measured.**" in page
    assert "100 motors a row." in page


def test_a_section_that_was_measured_on_earlier_code_is_visible() -> None:
    page = page_text(SECTIONS, {"one": measured(code="old", at="01:00"), "two": measured(at="02:00")})

    assert "All sections are measured at full size, **1 of them on earlier code**." in page
    assert page.count("**Measured on earlier code**") == 1
    assert page.index("**Measured on earlier code**") < page.index("## False alarms")


def test_a_run_of_one_section_leaves_the_others(tmp_path: Path) -> None:
    page = tmp_path / "condition.md"
    short = at_least("seen", 1, 2, 0.97)
    write_page(page, SECTIONS, {"one": measured(short)})
    write_page(page, SECTIONS, {"two": replace(measured(), share=0.5)})

    assert read_measured(page)["one"] == measured(short)
    text = page.read_text(encoding="utf-8")
    assert "All sections are measured, at different sizes, on the same code." in text
    assert f"| seen | at least 97 % | {short.found} | {SHORT} |" in text
    assert "No figure is asked for." in text


def test_the_page_and_its_tables_say_what_was_measured(tmp_path: Path) -> None:
    page = tmp_path / PAGE.name
    write_page(page, SECTIONS_OF_THE_PAGE, read_measured(PAGE))

    def written(folder: Path) -> dict[str, str]:
        files = [folder / PAGE.name, *sorted((folder / "data").glob("condition-*.csv"))]
        return {file.name: file.read_text(encoding="utf-8") for file in files}

    assert written(PAGE.parent) == written(tmp_path), (
        "docs/evidence/condition.md is written by python -m benchmarks.condition, or --write-page"
    )
