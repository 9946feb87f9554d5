"""An example that is run without its files says how it is run."""

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize(
    "name",
    [
        "commission_motor",
        "diagnose_recording",
        "make_month_of_records",
        "picture_of_a_condition",
        "picture_of_a_demo",
        "read_relay_reports",
    ],
)
def test_an_example_without_arguments_says_how_it_is_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", [f"{name}.py"])
    with pytest.raises(SystemExit, match=rf"python examples/{name}\.py"):
        runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")


@pytest.mark.parametrize("name", ["make_month_of_records", "make_running_record", "make_start_record"])
def test_an_example_that_is_asked_for_help_writes_nothing(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [f"{name}.py", "--help"])
    with pytest.raises(SystemExit, match=rf"python examples/{name}\.py"):
        runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    assert not [*tmp_path.iterdir()]
