"""`mcc report`: against the API on a real port."""

import json
from pathlib import Path

import openpyxl

from tests.service.cli.test_stored import (
    Mcc,
    client,
    database_url,
    engine,
    mcc,
    recorded,
    repository,
    store,
)

__all__ = ["client", "database_url", "engine", "mcc", "recorded", "repository", "store"]


def test_each_report_in_the_format_of_its_name(mcc: Mcc, recorded: list[str], tmp_path: Path) -> None:
    for words in (["fleet", "--period", "weekly"], ["motor", "PUMP-A1"], ["alarms", "--month", "2025-10"]):
        pdf = tmp_path / f"{words[0]}.pdf"
        assert mcc("report", *words, "--output", str(pdf)) == f"{pdf}: {pdf.stat().st_size} bytes\n"
        assert pdf.read_bytes().startswith(b"%PDF")
    xlsx = tmp_path / "motor.xlsx"
    mcc("report", "motor", "PUMP-A1", "--output", str(xlsx))
    assert "changes" in openpyxl.load_workbook(xlsx).sheetnames


def test_the_same_as_rest(mcc: Mcc, recorded: list[str], tmp_path: Path) -> None:
    path = tmp_path / "fleet.pdf"
    words = (
        "report",
        "fleet",
        "--until",
        "2025-10-09T09:00:00Z",
        "--site",
        "FACTORY_A",
        "--output",
        str(path),
    )
    mcc(*words)
    first = path.read_bytes()
    assert json.loads(mcc(*words, "--overwrite", "--json")) == {
        "report": "fleet",
        "file": str(path),
        "format": "pdf",
        "size_bytes": len(first),
    }
    assert path.read_bytes() == first


def test_what_cannot_be_made_leaves_no_file(mcc: Mcc, tmp_path: Path) -> None:
    path = tmp_path / "x.pdf"
    assert "there is no site 'FACTRY_A'" in mcc(
        "report", "fleet", "--site", "FACTRY_A", "--output", str(path), ends=1
    )
    assert "NOBODY" in mcc("report", "motor", "NOBODY", "--output", str(path), ends=1)
    assert list(tmp_path.glob("*x.pdf*")) == []
    assert "expected --output FILE" in mcc("report", "fleet", "--json", ends=2)
