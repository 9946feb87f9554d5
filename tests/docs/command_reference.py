"""Write the commands and their options into docs/reference/commands.md, from the programs: `make docs`."""

import re
from collections import Counter
from collections.abc import Container, Iterator

import typer

import ied_sim.cli
import service.cli.app
from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "reference" / "commands.md"
TYPES = re.compile(r" <(?:bool|int|float|str|path|list\[\w+\])>")
"""Names of Python types, which tell a reader nothing."""

SHARED_BY = 2
"""An option that so many commands have alike is explained once, in its most common meaning."""

ESCAPED = r"\["
"""How help texts write a bracket that is no mark-up."""


def commands() -> Iterator[tuple[str, typer.core.TyperCommand]]:
    """Yield each command with the words that start it, in the order of its program's help."""
    group = typer.main.get_command(service.cli.app.app)
    assert isinstance(group, typer.core.TyperGroup)
    yield from _commands_of("mcc", group)
    alone = typer.main.get_command(ied_sim.cli.app)
    assert isinstance(alone, typer.core.TyperCommand)
    yield "ied-sim", alone


def _commands_of(words: str, group: typer.core.TyperGroup) -> Iterator[tuple[str, typer.core.TyperCommand]]:
    for name, command in group.commands.items():
        if isinstance(command, typer.core.TyperGroup):
            yield from _commands_of(f"{words} {name}", command)
        else:
            assert isinstance(command, typer.core.TyperCommand)
            yield f"{words} {name}", command


def options(name: str, command: typer.core.TyperCommand) -> Iterator[tuple[str, str]]:
    """Yield a command's arguments and options, each with its meaning."""
    context = typer.Context(command, info_name=name)
    for parameter in command.params:
        record = parameter.get_help_record(context)
        if record is not None:
            usage, meaning = (text.replace(ESCAPED, "[") for text in record)
            yield f"`{TYPES.sub('', usage)}`", meaning.strip()


def lines(name: str, command: typer.core.TyperCommand, shared: Container[tuple[str, str]]) -> Iterator[str]:
    """Yield a command's section: what it does, its own arguments and options, and those that are shared."""
    found = list(options(name, command))
    yield f"## {name}"
    yield ""
    yield command.help or ""
    yield ""
    yield from (f"- {usage}: {meaning}" for usage, meaning in found if (usage, meaning) not in shared)
    others = [usage for usage, meaning in found if (usage, meaning) in shared]
    if others:
        yield f"- Shared: {', '.join(others)}"
    yield ""


def written(page: str) -> str:
    """Return the page with its commands made anew between their markers."""
    every = dict(commands())
    counts = Counter(option for name, command in every.items() for option in options(name, command))
    commonest = {usage: (usage, meaning) for (usage, meaning), _ in reversed(counts.most_common())}
    shared = {option for option in commonest.values() if counts[option] >= SHARED_BY}
    made = ["## Shared options", "", *(f"- {usage}: {meaning}" for usage, meaning in sorted(shared)), ""]
    made += [line for name, command in every.items() for line in lines(name, command, shared)]
    return between_markers(page, "commands", made)


def main() -> None:
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
