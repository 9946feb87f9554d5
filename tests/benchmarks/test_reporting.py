"""Large tables of a page of evidence are files beside it."""

from pathlib import Path

from benchmarks.reporting import Section, table, with_tables_as_files, write_sections

HEADER = ["motor", "level", "called"]
SMALL = table(HEADER, [["0.8 kW", "1 %", "**falls short**"]])
LARGE = table(HEADER, [*([f"{n} kW", "a, b", "`fault`"] for n in range(7)), ["all", "", "7 of 7"]])


def test_a_small_table_stays(tmp_path: Path) -> None:
    lines = ["About.", "", *SMALL, "", "Done."]
    assert with_tables_as_files(tmp_path / "page.md", "page", lines) == lines
    assert list(tmp_path.iterdir()) == []


def test_a_large_table_is_a_file_and_its_totals_stay(tmp_path: Path) -> None:
    lines = with_tables_as_files(tmp_path / "page.md", "page-one", ["About.", "", *LARGE, "", *LARGE])

    assert lines == [
        "About.", "", *table(HEADER, [["all", "", "7 of 7"]]), "", "[All 8 rows](data/page-one.csv)",
        "", *table(HEADER, [["all", "", "7 of 7"]]), "", "[All 8 rows](data/page-one-2.csv)",
    ]  # fmt: skip
    written = (tmp_path / "data" / "page-one.csv").read_text(encoding="utf-8").splitlines()
    assert written[:2] == ["motor,level,called", '0 kW,"a, b",fault']
    assert len(written) == 9


def test_sections_that_are_not_measured_keep_their_files(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    sections = [Section(name, name, "command", tuple(LARGE)) for name in ("one", "two")]
    write_sections(page, "# Page", ["one", "two"], sections)
    text = page.read_text(encoding="utf-8")
    write_sections(page, "# Page", ["one", "two"], sections[:1])

    assert page.read_text(encoding="utf-8") == text
    assert sorted(file.name for file in (tmp_path / "data").iterdir()) == ["page-one.csv", "page-two.csv"]
