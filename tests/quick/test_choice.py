"""Which tests a change is followed by: nearest first, as many as the time allows."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import grimp
import pytest

from tests.docs.pages import ROOT
from tests.quick.__main__ import reached_by, run_tests
from tests.quick.budget import COLLECT_S, END, PROCESSES, SECONDS, START_S, UNKNOWN_S, within
from tests.quick.changes import changed_files, changed_modules, module_of
from tests.quick.reach import Reached, imports_of, reached_tests

TEXTS = {
    "service/web/templates/motor/page.html": '{% include "motor/rotor.html" %}<script src="js/plot.js">',
    "service/web/templates/motor/rotor.html": "<h2>Rotor</h2>",
    "service/web/static/js/plot.js": 'import "./axis.js"',
    "service/web/static/js/axis.js": "",
    "other/axis.js": 'import "./plot.js"',
    "service/web/motor/routes.py": 'view.page("motor/page.html")',
    "core/losses/cost.py": "",
}
LONG = """import threading
def test_wrong(): assert False
def test_without_end(): threading.Event().wait()
"""
MODULES = {"service.web.motor.routes", "core.losses", "core.losses.cost", "statorwatch_client.client"}


@pytest.mark.parametrize(
    ("file", "modules"),
    [
        ("core/losses/cost.py", {"core.losses.cost"}),
        ("core/losses/__init__.py", {"core.losses"}),
        ("core/losses/gone.py", {"core.losses"}),
        ("client/statorwatch_client/client.py", {"statorwatch_client.client"}),
        ("service/web/templates/motor/rotor.html", {"service.web.motor.routes"}),
        ("service/web/static/js/axis.js", {"service.web.motor.routes"}),
        ("LICENSE", set()),
    ],
)
def test_a_file_changes_its_module_or_those_that_name_it(file: str, modules: set[str]) -> None:
    assert changed_modules([file], MODULES, TEXTS) == modules


def test_a_test_is_as_far_as_the_imports_between() -> None:
    importers: dict[str, set[str]] = {
        "core.a": {"core", "tests.core.test_a"},
        "core": {"service.b", "tests.core.test_core"},
        "service.b": {"tests.service.test_b", "service.b.loop"},
        "service.b.loop": {"service.b"},
        "service.apart": {"tests.test_apart"},
        "tests.core.test_a": set(),
        "tests.core.test_core": set(),
        "tests.service.test_b": set(),
        "tests.test_apart": set(),
    }
    assert reached_tests(["core.a"], importers) == [
        Reached("tests/core/test_a.py", 1),
        Reached("tests/core/test_core.py", 2),
        Reached("tests/service/test_b.py", 3),
    ]
    assert reached_tests(["tests.test_apart"], importers) == [Reached("tests/test_apart.py", 0)]
    assert reached_tests([], importers) == []


def test_tests_of_the_own_room_come_first() -> None:
    importers: dict[str, set[str]] = {
        "service.storage.rows": {"tests.api.test_a", "service.storage"},
        "service.storage": {"tests.service.storage.test_z"},
        "tests.api.test_a": set(),
        "tests.service.storage.test_z": set(),
    }
    found = reached_tests(["service.storage.rows"], importers)
    assert [one.file for one in found] == ["tests/service/storage/test_z.py", "tests/api/test_a.py"]


def test_what_fixtures_import_reaches_the_tests_that_they_serve() -> None:
    graph = grimp.ImportGraph()
    for module in ("service.a", "tests.room.conftest", "tests.room.test_x", "tests.other.test_y"):
        graph.add_module(module)
    graph.add_import(importer="tests.room.conftest", imported="service.a")
    assert reached_tests(["service.a"], imports_of(graph)) == [Reached("tests/room/test_x.py", 2)]


def test_time_goes_to_the_nearest_that_fit() -> None:
    tests = [Reached(f"tests/test_{name}.py", 1) for name in ("a", "b", "c", "new")]
    seconds = {"tests/test_a.py::one": 4.0, "tests/test_a.py::two": 3.0, "tests/test_b.py::one": 90.0}
    seconds |= {"tests/test_c.py::one": 1.0}
    chosen = within(tests, seconds, START_S + (8.5 + UNKNOWN_S) / PROCESSES + 3 * COLLECT_S)
    assert [one.file for one in chosen] == ["tests/test_a.py", "tests/test_c.py", "tests/test_new.py"]
    assert within(tests, seconds, START_S) == []


def test_changes_are_those_since_the_branch_left_main(tmp_path: Path) -> None:
    def git(*arguments: str) -> None:
        identity = ["-c", "user.name=a", "-c", "user.email=a@b"]
        subprocess.run(["git", *identity, *arguments], cwd=tmp_path, check=True)

    git("init", "--quiet", "--initial-branch", "main")
    for name in ("kept", "moved", "edited"):
        (tmp_path / name).write_text(name)
    git("add", ".")
    git("commit", "--quiet", "--message", "first")
    assert changed_files(tmp_path) == []
    git("checkout", "--quiet", "-b", "branch")
    git("mv", "moved", "there")
    git("commit", "--quiet", "--message", "second")
    (tmp_path / "edited").write_text("otherwise")
    (tmp_path / "new").write_text("new")
    assert changed_files(tmp_path) == ["edited", "moved", "new", "there"]
    assert changed_files(tmp_path, "HEAD") == ["edited", "new"]


@pytest.mark.parametrize(
    ("file", "nearest"),
    [
        ("core/losses/cost.py", "tests/core/losses/"),
        ("service/storage/texts.py", "tests/service/storage/"),
        ("service/web/templates/starts/all.html", "tests/service/web/starts/"),
        ("tests/docs/test_links.py", "tests/docs/test_links.py"),
    ],
)
def test_a_file_of_this_tree_is_followed_by_tests_of_its_room(file: str, nearest: str) -> None:
    assert (ROOT / file).exists()
    found = [one for one in reached_by([file]) if "/quick/" not in one.file]  # which names the file, too
    assert module_of(found[0].file)
    assert found[0].file.startswith(nearest)


def test_no_test_begins_too_late_and_what_ran_is_noted(tmp_path: Path) -> None:
    """In a real run: one of three tests would take too long, by what it took before."""
    (tmp_path / "test_b.py").write_text("def test_long(): pass\ndef test_short(): pass\n")
    (tmp_path / "test_a.py").write_text("def test_last(): pass\n")
    kept = tmp_path / "kept" / "seconds.json"
    kept.parent.mkdir()
    kept.write_text(
        '{"test_b.py::test_long": 1000, "test_b.py::test_short": 0.1, "test_a.py::test_last": 0.1}'
    )
    path = os.pathsep.join((str(ROOT), os.environ.get("PYTHONPATH", "")))
    environment = {**os.environ, "PYTHONPATH": path, SECONDS: str(kept), END: str(time.time() + 100)}
    command = [sys.executable, "-m", "pytest", "--rootdir", str(tmp_path), "-c", os.devnull, "-n", "0", "-v"]
    command += ["-p", "tests.quick.budget", "-p", "no:cacheprovider", "test_b.py", "test_a.py"]
    ended = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    lines = [line.split()[:2] for line in ended.stdout.splitlines() if "::" in line]
    assert lines == [
        ["test_b.py::test_long", "SKIPPED"],
        ["test_b.py::test_short", "PASSED"],
        ["test_a.py::test_last", "PASSED"],
    ]
    seconds = json.loads(kept.read_text())
    assert seconds["test_b.py::test_long"] == 1000
    assert seconds["test_a.py::test_last"] < 0.1


@pytest.mark.campaign
def test_a_run_that_is_stopped_says_whether_a_test_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(ROOT), os.environ.get("PYTHONPATH", ""))))
    (tmp_path / ".quick").mkdir()
    (tmp_path / "test_long.py").write_text(LONG)
    now_s = time.time()
    assert run_tests([Reached("test_long.py", 1)], tmp_path, end_s=now_s + 100, stop_s=now_s + 30) == 1
    assert "stopped, no time" in capsys.readouterr().out
