"""What is installed is what was pinned, to the bit."""

import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from release.pins import PinError, normalised, read_pins
from tests.deployment.image import commands_running
from tests.docs.pages import ROOT

CONSTRAINTS = {pin.name: pin.version for pin in read_pins(ROOT / "constraints.txt")}
INSTALLED = read_pins(ROOT / "requirements.txt")


def names_of(requirements: list[str]) -> set[str]:
    return {normalised(Requirement(one).name) for one in requirements}


def test_each_package_of_the_image_has_hashes() -> None:
    assert [pin.name for pin in INSTALLED if not pin.sha256] == []


def test_the_image_has_the_versions_that_tests_ran_with() -> None:
    assert {pin.name: pin.version for pin in INSTALLED} == {
        pin.name: CONSTRAINTS.get(pin.name) for pin in INSTALLED
    }


def test_the_image_has_all_that_the_service_needs() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    needed = names_of([*project["dependencies"], *extras["postgres"], *extras["s3"], *extras["tables"]])
    assert len(needed) > 20
    assert needed - {pin.name for pin in INSTALLED} == set()


def test_the_image_installs_no_file_of_another_hash() -> None:
    (install,) = commands_running("pip", "install", "--require-hashes") or commands_running(
        "--require-hashes"
    )
    assert install[install.index("--requirement") + 1] == "requirements.txt"


def test_what_is_no_pin_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "constraints.txt"
    path.write_text("numpy>=2\n")
    with pytest.raises(PinError, match=r"expected lines such as numpy==2\.3\.1, found 'numpy>=2'"):
        read_pins(path)
