"""The tutorial's commands run, one after the other, and find what the tutorial says they find."""

import json
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest

from core.diagnosis.verdict import Verdict
from core.recordings import read
from examples import make_running_record
from service.cli import main
from service.configuration.settings import Settings
from service.plant import read_plant
from tests.docs.pages import ROOT

PAGE = (ROOT / "docs" / "tutorial" / "first-steps.md").read_text(encoding="utf-8")


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What a reader's folder holds, for commands to write beside."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("scl/demo_plant.scd", "service/demo/motors.toml", "service/demo/scenario.toml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def commands() -> list[list[str]]:
    """The lines of the page's `sh` blocks; those that start programs to stay are in other blocks."""
    blocks = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    return [shlex.split(line) for block in blocks for line in block.splitlines()]


def run(command: list[str]) -> None:
    match command:
        case ["mcc", *arguments]:
            assert main(arguments) == 0
        case ["mkdir", folder]:
            Path(folder).mkdir()
        case ["cp", *sources, target]:
            for source in sources:
                shutil.copy(source, target)
        case _:
            pytest.fail(f"the tutorial has a command this test does not know: {command}")


def test_the_commands_find_what_the_page_says(checkout: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = []
    for command in commands():
        run(command)
        out = capsys.readouterr().out
        if "--json" in command:
            diagnosis = json.loads(out)
            assert diagnosis["phase"] == "b"
            assert diagnosis["mu_f"] == pytest.approx(0.05, rel=0.05)
        elif "diagnose" in command:
            found.append(next(word for word in out.split() if word in set(Verdict)))
    assert found == ["fault", "undiagnosable", "fault"]

    (settings,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    (checkout / "my-plant" / "mcc.toml").write_text(settings, encoding="utf-8")
    assert len(read_plant(Settings.load(checkout / "my-plant" / "mcc.toml")).motors) == 6


def test_the_example_record_is_that_of_its_program() -> None:
    kept = read(ROOT / "examples" / "RUNNING.CFG").samples
    made = make_running_record.running_record().samples
    step = np.abs(kept).max(axis=1, keepdims=True) / 2**13
    assert (np.abs(kept - made) < step).all()
