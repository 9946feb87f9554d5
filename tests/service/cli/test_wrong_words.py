"""A command that is used wrongly, or beside misspelt variables, says so."""

from pathlib import Path

import pytest

from core.recordings import RecordingError, read
from service.cli.app import main


def test_a_misspelt_variable_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MCC_ULR", "http://secret@127.0.0.1:1")
    assert main(["motors", "--url", "http://127.0.0.1:1"]) == 1
    told = capsys.readouterr().err
    [warning] = [line for line in told.splitlines() if "warning" in line]
    assert "MCC_ULR" in warning
    assert "did you mean MCC_URL?" in warning
    assert "secret" not in told


def test_known_variables_are_no_typos(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MCC_PORT", "1")
    assert main(["motors", "--url", "http://127.0.0.1:1"]) == 1
    assert "warning" not in capsys.readouterr().err


def test_a_command_names_its_own_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trend"]) == 2
    assert "(mcc trend --help tells the way)" in capsys.readouterr().err


def test_an_archive_is_to_be_unpacked() -> None:
    with pytest.raises(RecordingError, match="unpack the archive first"):
        read(Path("RECORD.zip"))
