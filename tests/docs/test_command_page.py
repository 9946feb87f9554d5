"""docs/reference/commands.md has the commands and options of the programs."""

from tests.docs.command_reference import PAGE, written
from tests.docs.pages import ROOT


def test_the_page_is_that_of_the_programs() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == written(page), "the commands have changed: run `make docs` and commit the page"


def test_the_readme_leads_to_the_list_of_commands() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "`mcc --help` lists all commands; [Commands](docs/reference/commands.md)" in readme
    assert len(readme.split()) <= 900
