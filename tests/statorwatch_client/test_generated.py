"""The typed client is what the API's own description gives, and stands alone."""

import inspect
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

from statorwatch_client.operations import Operations
from testing.api_client.document import openapi_document
from testing.api_client.making import PACKAGE, written_modules
from testing.api_client.operations import python_type


def test_it_is_what_the_api_gives() -> None:
    for name, text in written_modules().items():
        assert (PACKAGE / name).read_text(encoding="utf-8") == text, f"{name}: run make client"


def test_every_operation_is_a_method() -> None:
    paths = openapi_document()["paths"]
    named = {
        operation["operationId"]
        for path, operations in paths.items()
        if path.startswith("/api/v1")
        for operation in operations.values()
    }
    methods = {name for name, _ in inspect.getmembers(Operations, inspect.isfunction)}
    assert named <= methods
    assert {name for name in methods - named if not name.startswith(("iter_", "_"))} == set()


def test_a_parameter_of_an_unknown_kind_is_no_guess() -> None:
    with pytest.raises(ValueError, match="another kind"):
        python_type({"type": "object"})


def test_the_small_wheel_stands_alone(tmp_path: Path) -> None:
    """Built as a user gets it, it imports httpx and nothing of the service's."""
    command = ["pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(tmp_path)]
    source = tmp_path / "source"
    source.mkdir()
    for path in PACKAGE.iterdir():
        if path.is_file():
            (source / path.name).write_bytes(path.read_bytes())
    subprocess.run([sys.executable, "-m", *command, str(source)], check=True, cwd=tmp_path)
    (wheel,) = tmp_path.glob("statorwatch_client-*.whl")
    assert wheel.stat().st_size < 100_000
    with ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "installed")
    assert (tmp_path / "installed" / "statorwatch_client" / "py.typed").exists()
    told = (
        "import sys, statorwatch_client; print(statorwatch_client.__file__); "
        "print(sorted({'service', 'core', 'mms', 'numpy', 'pydantic', 'sqlalchemy'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", told],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path / "installed")},
    )
    file, loaded = done.stdout.splitlines()
    assert Path(file).is_relative_to(tmp_path)
    assert loaded == "[]"
