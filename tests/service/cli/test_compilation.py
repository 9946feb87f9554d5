"""People are told why the first command after an installation takes longer."""

import io
from contextlib import nullcontext

import pytest
from rich.console import Console
from rich.progress import Progress

from service.cli import compilation
from service.cli.compilation import CompilationBar

LINE = "compiling the machine models, once after an installation: half a minute\n"


def test_a_log_has_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    bar = CompilationBar(silent_s=0.0)
    for ready in (3, 4):
        with bar(ready, 42):
            pass
    assert capsys.readouterr().err == LINE


def test_a_function_or_two_are_compiled_in_silence(capsys: pytest.CaptureFixture[str]) -> None:
    assert isinstance(CompilationBar(silent_s=60.0)(3, 42), nullcontext)
    assert capsys.readouterr().err == ""


def test_a_terminal_has_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = io.StringIO()
    terminal = Console(file=shown, force_terminal=True, width=100)
    monkeypatch.setattr(compilation, "progress", lambda: terminal)
    bar = CompilationBar(silent_s=0.0)(3, 42)
    assert isinstance(bar, Progress)
    with bar:
        pass
    assert "compiling, once after an installation" in shown.getvalue()
    assert "3/42" in shown.getvalue()
