"""docs/reference/commands.md has the commands and options of the programs."""

from tests.docs.command_reference import PAGE, commands, written
from tests.docs.pages import ROOT


def test_the_page_is_that_of_the_programs() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == written(page), "the commands have changed: run `make docs` and commit the page"


def test_the_readme_lists_every_command() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert [name for name, _ in commands() if f"\n    {name} " not in readme] == []
