"""The bill of materials: valid, complete, and in the wheel; so are the help pages."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

from release.bill_of_materials import NAME, SPECIFICATION, bill_of_materials
from release.help_site import FOLDER
from release.pins import read_pins
from tests.docs.pages import ROOT

BUILT_FROM = ("client", "core", "docs", "ied_sim", "mms", "release", "scl", "service")
FILES = ("LICENSE", "README.md", "mkdocs.yml", "pyproject.toml", "requirements.txt", "setup.py")


def test_the_bill_is_valid_cyclonedx() -> None:
    assert SchemaVersion.from_version(SPECIFICATION) is SchemaVersion.V1_6
    found = JsonStrictValidator(SchemaVersion.V1_6).validate_str(bill_of_materials(ROOT))
    assert found is None, found


def test_the_bill_names_each_package_with_its_hashes() -> None:
    components = json.loads(bill_of_materials(ROOT))["components"]
    assert [
        (one["name"], one["version"], {each["content"] for each in one["externalReferences"][0]["hashes"]})
        for one in components
    ] == [(pin.name, pin.version, set(pin.sha256)) for pin in read_pins(ROOT / "requirements.txt")]
    assert "pkg:pypi/pyiec61850-ng@1.6.1.10" in {one["purl"] for one in components}


def test_the_wheel_has_the_bill_and_the_help_pages(tmp_path: Path) -> None:
    tree = tmp_path / "tree"
    for folder in BUILT_FROM:
        left_out = shutil.ignore_patterns("__pycache__", "*.nb[ci]", "build", "*.egg-info", "site")
        shutil.copytree(ROOT / folder, tree / folder, ignore=left_out)
    for file in FILES:
        shutil.copy(ROOT / file, tree / file)
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--quiet"]
    subprocess.run([*command, "--wheel-dir", str(tmp_path), str(tree)], check=True)
    (wheel,) = tmp_path.glob("*.whl")
    with ZipFile(wheel) as archive:
        assert archive.read(f"service/{NAME}").decode() == bill_of_materials(ROOT)
        assert not [name for name in archive.namelist() if name.startswith("release/")]
        assert b'id="of-a-record"' in archive.read(f"{FOLDER}/reference/losses.html")


def test_the_image_is_built_from_what_makes_the_bill() -> None:
    lines = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    assert {f"!{name}" for name in (*BUILT_FROM, *FILES)} <= set(lines)
