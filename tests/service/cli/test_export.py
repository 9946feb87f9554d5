"""`mcc export`: against the API on a real port."""

import json
from pathlib import Path

import openpyxl
import pytest
from pyarrow import parquet

from service.api.exports import answers
from tests.service.cli.test_stored import (
    Mcc,
    client,
    database_url,
    engine,
    mcc,
    recorded,
    repository,
    rows,
    store,
)

__all__ = ["client", "database_url", "engine", "mcc", "recorded", "repository", "store"]


def test_a_file_in_the_format_of_its_name(mcc: Mcc, recorded: list[str], tmp_path: Path) -> None:
    for name in ("trend.csv", "trend.XLSX", "trend.parquet"):
        path = tmp_path / name
        assert (
            mcc("export", "trend", "PUMP-A1", "--output", str(path))
            == f"{path}: {path.stat().st_size} bytes\n"
        )
    assert [row["recording_id"] for row in rows((tmp_path / "trend.csv").read_text())] == recorded
    sheet = openpyxl.load_workbook(tmp_path / "trend.XLSX")["trend"]
    assert sheet.max_row == 5
    assert parquet.read_table(tmp_path / "trend.parquet")["recording_id"].to_pylist() == recorded
    assert sorted(path.name for path in tmp_path.iterdir() if path.name.startswith((".", "trend"))) == [
        "trend.XLSX",
        "trend.csv",
        "trend.parquet",
    ]


def test_without_a_file_the_rows_go_to_standard_output(mcc: Mcc, recorded: list[str]) -> None:
    assert [row["recording_id"] for row in rows(mcc("export", "trend"))] == recorded
    assert len(rows(mcc("export", "recordings", "PUMP-A1", "FAN-A2"))) == 4
    assert rows(mcc("export", "measurements", "--step", "60")) == []
    assert rows(mcc("export", "alarms")) == []
    assert rows(mcc("export", "starts")) == []
    window = rows(
        mcc("export", "trend", "PUMP-A1", "--from", "2025-10-09T08:53:21Z", "--to", "2025-10-09T08:53:23Z")
    )
    assert [row["recording_id"] for row in window] == recorded[1:3]


def test_a_file_that_is_there_is_left_alone(mcc: Mcc, recorded: list[str], tmp_path: Path) -> None:
    path = tmp_path / "trend.csv"
    path.write_text("mine")
    told = mcc("export", "trend", "--output", str(path), ends=1)
    assert "--overwrite replaces it" in told
    assert path.read_text() == "mine"
    document = json.loads(mcc("export", "trend", "--output", str(path), "--overwrite", "--json"))
    assert document == {
        "table": "trend",
        "file": str(path),
        "format": "csv",
        "size_bytes": path.stat().st_size,
    }
    assert len(rows(path.read_text())) == 4


def test_a_file_that_cannot_be_completed_is_none(
    mcc: Mcc, recorded: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "LONGEST_S", -1.0)
    path = tmp_path / "folder" / "trend.csv"
    path.parent.mkdir()
    assert mcc("export", "trend", "--output", str(path), ends=1)
    assert list(path.parent.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "ends", "told"),
    [
        (["trend", "PUMP-A9"], 1, "there is no motor 'PUMP-A9'; did you mean 'PUMP-A1'?"),
        (["trend", "--from", "yesterday"], 1, "expected an RFC 3339 time"),
        (["trend", "--json"], 2, "expected --output FILE"),
        (["trend", "--format", "pdf"], 2, "'csv', 'xlsx', 'parquet'"),
        (["trends"], 2, "trend"),
        (["trend", "--output", "/nowhere/at/all.csv"], 1, "/nowhere/at"),
    ],
)
def test_what_is_wrong_is_told_in_words(
    mcc: Mcc, recorded: list[str], words: list[str], ends: int, told: str
) -> None:
    assert told in mcc("export", *words, ends=ends)
