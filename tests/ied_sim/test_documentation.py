"""docs/reference/simulator.md: every profile, key and kind is there, and its example is a profile."""

import re
from pathlib import Path

import pytest

from ied_sim.misbehaviour import PARAMETERS, Kind
from ied_sim.profiles.profile import Files, Points, Profile, Record, Triggers, read_profile, shipped
from ied_sim.scenario.scenario import read_scenario
from ied_sim.texts.catalogue import MAKERS

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "simulator.md").read_text(encoding="utf-8")


def test_profiles_kinds_and_reports_are_documented() -> None:
    names = [*shipped(), *Kind, *(name for name, _ in PARAMETERS.values()), *MAKERS]
    assert [name for name in names if f"`{name}`" not in PAGE] == []


@pytest.mark.parametrize("table", [Profile, Points, Record, Triggers, Files])
def test_every_key_of_a_profile_is_in_the_example(table: type[Profile]) -> None:
    example, _fault = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    keys = set(table.model_fields) - {"path"}
    assert [key for key in keys if not re.search(rf"\b{key}\b", example)] == []


def test_the_example_of_a_fault_is_a_scenario(tmp_path: Path) -> None:
    _profile, example = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "fault.toml").write_text(example, encoding="utf-8")
    (scenario,) = read_scenario(tmp_path / "fault.toml", "sel-710-ed1").values()
    assert [each.kind for each in scenario.misbehaviour] == [Kind.FROZEN]


def test_the_example_is_a_profile(tmp_path: Path) -> None:
    example, _fault = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "own.icd").write_bytes(read_profile("rdre").icd_path.read_bytes())
    (tmp_path / "own.toml").write_text(example, encoding="utf-8")
    profile = read_profile("own.toml", beside=tmp_path)
    assert profile.files is not None
    assert profile.record.samples_per_cycle == 32
