"""What `--help` prints is what the commands' docstrings say, in full."""

import pytest

from service.cli.app import app, main

COMMANDS = {
    command.name or command.callback.__name__.replace("_", "-"): command.callback.__doc__ or ""
    for group in app.registered_groups
    for command in (group.typer_instance.registered_commands if group.typer_instance else ())
    if command.callback is not None
}


@pytest.mark.parametrize("name", COMMANDS)
def test_no_word_of_a_command_is_taken_for_mark_up(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main([name, "--help"]) == 0
    assert " ".join(COMMANDS[name].split()) in " ".join(capsys.readouterr().out.split())


def test_brackets_of_an_option_are_not_taken_for_mark_up(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["follow", "--help"]) == 0
    assert "A file of events (TOML, tables [[event]])." in capsys.readouterr().out
