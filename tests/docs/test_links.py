"""Every link between pages leads somewhere, and every path that a page or a message names exists."""

import re
from pathlib import Path

import pytest

from tests.docs.pages import ROOT, anchors, pages, text_files

LINK = re.compile(r"\]\((?!https?:|mailto:)([^)\s]+)\)")
DOCS_PATH = re.compile(r"(?<![\w/.])docs/[\w./-]*\w")
CODE_PATH = re.compile(
    r"`((?:benchmarks|core|docs|examples|ied_sim|mms|scl|service|testing|tests|\.ci|\.github)/[\w./-]*\w)`"
)
TEST_ID = re.compile(r"`((?:[\w.-]+/)*test_\w+\.py)(?:::(\w+))?`")
MODULE = re.compile(r"python -m ((?:benchmarks|core|ied_sim|mms|scl|service|tests)[\w.]*\w)")
MAKE = re.compile(r"(?:`|^    )make ([a-z][a-z-]*)", re.MULTILINE)
HISTORY = {"CHANGELOG.md", "track-record.md"}
"""Pages that tell of the past; code they name may have moved since."""


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", pages(), ids=name)
def test_links_lead_to_a_file_and_a_heading(page: Path) -> None:
    broken = []
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        path, _, anchor = link.partition("#")
        target = (page.parent / path) if path else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            broken.append(link)
    assert broken == []


@pytest.mark.parametrize("page", [page for page in pages() if page.name not in HISTORY], ids=name)
def test_code_paths_exist(page: Path) -> None:
    paths = [
        path for path in CODE_PATH.findall(page.read_text(encoding="utf-8")) if "__pycache__" not in path
    ]
    assert [path for path in paths if not (ROOT / path).exists()] == []


@pytest.mark.parametrize("page", pages(), ids=name)
def test_tests_that_are_named_exist(page: Path) -> None:
    missing = []
    for path, function in TEST_ID.findall(page.read_text(encoding="utf-8")):
        places = [folder / path for folder in (ROOT, ROOT / "tests", ROOT / "tests" / "service")]
        found = [place for place in places if place.is_file()]
        if not found or (function and f"def {function}(" not in found[0].read_text(encoding="utf-8")):
            missing.append(f"{path}::{function}")
    assert missing == []


@pytest.mark.parametrize("page", pages(), ids=name)
def test_commands_that_are_named_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    assert [target for target in MAKE.findall(text) if target not in targets] == []
    assert [module for module in MODULE.findall(text) if not _runs(ROOT / module.replace(".", "/"))] == []


def _runs(module: Path) -> bool:
    return module.with_suffix(".py").is_file() or (module / "__main__.py").is_file()


def test_every_documentation_path_that_is_named_exists() -> None:
    missing = [
        (name(file), path)
        for file in text_files()
        for path in DOCS_PATH.findall(file.read_text(encoding="utf-8"))
        if not (ROOT / path).exists()
    ]
    assert missing == []


def test_the_index_leads_to_every_page() -> None:
    index = ROOT / "docs" / "README.md"
    linked = {
        (index.parent / link.partition("#")[0]).resolve() for link in LINK.findall(index.read_text("utf-8"))
    }
    assert {page for page in pages() if page.is_relative_to(index.parent)} - linked == {index}


def test_the_index_names_every_example() -> None:
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    examples = [file.name for file in (ROOT / "examples").glob("*.py") if file.name != "__init__.py"]
    assert [example for example in examples if f"`examples/{example}`" not in index] == []
