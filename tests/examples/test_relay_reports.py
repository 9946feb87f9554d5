"""The example that reads relay reports."""

import runpy
import sys
from pathlib import Path

import pytest

from tests.core.relay_reports.examples import LDP, MOT, MSR

EXAMPLE = Path(__file__).parents[2] / "examples" / "read_relay_reports.py"


def run(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", [EXAMPLE.name, str(folder)])
    runpy.run_path(str(EXAMPLE), run_name="__main__")


def test_it_tells_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, report in (("MSR", MSR), ("LDP", LDP), ("MOT", MOT)):
        (tmp_path / f"{name}.TXT").write_text(report, encoding="ascii")
    run(tmp_path, monkeypatch)
    assert capsys.readouterr().out.splitlines() == [
        "start 2026-03-28T08:00:00: did not end, at most 9.01 A",
        "start 2026-03-29T10:15:01: 0.30 s, at most 8.62 A",
        "load profile: 2 rows; mean IA_MAG 1.254, IB_MAG 1.249, P 474.5",
        "statistics: running 120.1 h, 17 starts, trips {'overcurrent': 1, 'thermal overload': 0}",
        "SER: none",
    ]


def test_it_names_what_it_cannot_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "MSR.TXT").write_text("hello", encoding="ascii")
    with pytest.raises(SystemExit, match=r'MSR\.TXT: end: expected "Date of start"'):
        run(tmp_path, monkeypatch)
