"""A motor keeps its number for good."""

from pathlib import Path

import pytest

from service.gateways.kept_file import KeptFileError
from service.gateways.numbering import MotorNumbers


def test_numbers_outlive_motors_and_processes(tmp_path: Path) -> None:
    file = tmp_path / "numbers.json"
    assert MotorNumbers(file).of(["PUMP-A1", "FAN-A2"]) == {"FAN-A2": 0, "PUMP-A1": 1}
    assert MotorNumbers(file).of(["AGITATOR", "PUMP-A1"]) == {"FAN-A2": 0, "PUMP-A1": 1, "AGITATOR": 2}
    assert MotorNumbers(file).of([]) == {"FAN-A2": 0, "PUMP-A1": 1, "AGITATOR": 2}


@pytest.mark.parametrize("text", ["{", "[]", '{"A": -1}', '{"A": true}', '{"A": 1, "B": 1}'])
def test_a_file_that_is_something_else_is_told_and_kept(tmp_path: Path, text: str) -> None:
    file = tmp_path / "numbers.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(KeptFileError, match=r"numbers\.json: expected"):
        MotorNumbers(file)
    assert file.read_text(encoding="utf-8") == text
