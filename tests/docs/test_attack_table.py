"""docs/evidence/attacks.md has a row for each attack, and each test that it names is there to be run."""

import re

import pytest

from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "evidence" / "attacks.md"
ROW = re.compile(r"^\| ([^|]+) \| `(tests/[\w/]+\.py)(?:::(\w+))?` \|$", re.MULTILINE)
SUITE = PAGE.read_text(encoding="utf-8").partition("## The attack suite")[2]
ROWS = ROW.findall(SUITE)


@pytest.mark.parametrize(("attack", "path", "function"), ROWS)
def test_what_holds_an_attack_is_a_test_that_is_not_put_off(attack: str, path: str, function: str) -> None:
    content = (ROOT / path).read_text(encoding="utf-8")
    found = re.search(
        rf"((?:^@.*\n|^ .*\n|^\].*\n|^\).*\n)*)^def {function or 'test_'}", content, re.MULTILINE
    )
    assert found is not None, f"{attack}: {path}::{function}"
    assert not re.search(r"skip|xfail|campaign", found[1]), f"{attack}: {found[1]}"


def test_no_row_is_without_a_test_and_no_attack_without_a_row() -> None:
    lines = [
        line for line in SUITE.splitlines() if line.startswith("| ") and not line.startswith("| Attack |")
    ]
    assert len(lines) == len(ROWS) == len({attack for attack, *_ in ROWS})
    files = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests" / "attacks").glob("test_*.py")}
    assert files <= {path for _, path, _ in ROWS}


def test_the_count_is_that_of_the_rows() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert between_markers(text, "open", iter([f"{len(ROWS)} attacks, 0 open."])) == text
