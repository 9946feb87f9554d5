"""The distribution statorwatch-client: built, installed where nothing else of ours is, and used there."""

import json
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from zipfile import ZipFile

import httpx
import pytest

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, fault
from tests.docs.pages import ROOT
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]

MOST_BYTES = 100_000

PROGRAM = """
import json
import sys

from statorwatch_client import Client, ProblemError
from statorwatch_client.models import TrendPoint

def levels(points: list[TrendPoint]) -> list[float]:
    return [point["value"] for point in points if point["value"] is not None]

with Client(sys.argv[1], token=sys.argv[2]) as service:
    found = levels(list(service.get_trend("PUMP-A1")))
    try:
        service.get_motor("NONE")
        status = None
    except ProblemError as error:
        status = error.status

foreign = [name for name in ("numba", "numpy", "pydantic", "service", "core", "mms") if name in sys.modules]
print(json.dumps([found, status, foreign]))
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    shutil.copytree(ROOT / "client", folder / "client", ignore=shutil.ignore_patterns("build", "*.egg-info"))
    pip("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), str(folder / "client"))
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def python(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An interpreter that has the wheel and what it says that it needs, and nothing else."""
    folder = tmp_path_factory.mktemp("venv")
    venv.create(folder, with_pip=False, symlinks=True)
    (site,) = folder.glob("lib/python*/site-packages")
    for name in closure(requirements_of(wheel)):
        for file in distribution(name).files or ():
            if ".." not in file.parts:
                target = site / file
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(str(file.locate()), target)
    pip("--python", str(folder / "bin/python"), "install", "--no-index", "--no-deps", str(wheel))
    return folder / "bin/python"


def pip(*words: str) -> None:
    command = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def requirements_of(wheel: Path) -> list[str]:
    with ZipFile(wheel) as archive:
        (name,) = [one for one in archive.namelist() if one.endswith(".dist-info/METADATA")]
        text = archive.read(name).decode()
    return [line.partition(": ")[2] for line in text.splitlines() if line.startswith("Requires-Dist: ")]


def closure(requirements: list[str]) -> set[str]:
    """Names of all distributions that these need, without extras."""
    found: set[str] = set()
    waiting = list(requirements)
    while waiting:
        requirement = waiting.pop()
        named = re.match(r"[\w.-]+", requirement)
        assert named is not None
        if "extra ==" not in requirement and named[0] not in found and not is_for_others(requirement):
            found.add(named[0])
            waiting += distribution(named[0]).requires or ()
    return found


def is_for_others(requirement: str) -> bool:
    """Whether it is for another version of Python than this one."""
    below = re.search(r'python_(?:full_)?version < "3\.(\d+)', requirement)
    return below is not None and sys.version_info >= (3, int(below[1]))


@pytest.fixture
def served(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    add_diagnosed(repository, store, fault(0.02), NOW_NS, name="E1")
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


def test_it_is_small_and_needs_httpx_alone(wheel: Path) -> None:
    assert requirements_of(wheel) == ["httpx>=0.28"]
    assert wheel.stat().st_size < MOST_BYTES
    with ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert {name.partition("/")[0] for name in names} == {"statorwatch_client"}
    assert {"statorwatch_client/py.typed", "statorwatch_client/models.py"} <= names


def test_it_works_where_nothing_else_of_ours_is(python: Path, served: httpx.Client, tmp_path: Path) -> None:
    made = served.post("/api/v1/account/tokens", json={"label": "reader", "scope": ["view"]})
    token = made.raise_for_status().json()["token"]
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    words = [str(python), "-I", "-W", "error", str(program), str(served.base_url), token]
    done = subprocess.run(words, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [[0.02], 404, []]


def checked(python: Path, program: Path) -> subprocess.CompletedProcess[str]:
    words = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--config-file",
        "",
        "--python-executable",
        str(python),
    ]
    cache = ["--cache-dir", str(program.parent / "cache")]
    return subprocess.run(
        [*words, *cache, str(program)], capture_output=True, text=True, check=False, cwd=program.parent
    )


def test_its_users_are_checked(python: Path, tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    found = checked(python, program)
    assert found.returncode == 0, found.stdout
    program.write_text(PROGRAM.replace('point["value"] for', 'point["mu"] for'))
    found = checked(python, program)
    assert 'TypedDict "TrendPoint" has no key "mu"' in found.stdout


def test_it_has_the_version_of_the_service() -> None:
    versions = [
        tomllib.loads((ROOT / folder / "pyproject.toml").read_text())["project"]["version"]
        for folder in (".", "client")
    ]
    assert versions[0] == versions[1]
