"""Shows that the machine models are compiled: once after an installation, while somebody waits."""

import time
from contextlib import AbstractContextManager, nullcontext
from typing import Final

from service.cli.output import progress

SILENT_S: Final = 1.0
"""So long nobody is told: a function or two that an update has changed."""


class CompilationBar:
    """A bar on stderr while functions are compiled, where that is a terminal; else one line.

    silent_s: so long nothing is shown.
    """

    def __init__(self, silent_s: float = SILENT_S) -> None:
        self._silent_s = silent_s
        self._begun_s: float | None = None
        self._is_told = False

    def __call__(self, ready: int, of: int) -> AbstractContextManager[object]:
        """Show how many are ready, until the next one is."""
        now_s = time.monotonic()
        if self._begun_s is None:
            self._begun_s = now_s
        if now_s - self._begun_s < self._silent_s:
            return nullcontext()
        console = progress()
        if console.is_terminal:
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

            text = TextColumn("compiling, once after an installation")
            columns = (text, BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
            bar = Progress(*columns, console=console, transient=True)
            bar.add_task("", total=of, completed=ready)
            return bar
        if not self._is_told:
            self._is_told = True
            console.print("compiling the machine models, once after an installation: half a minute")
        return nullcontext()
