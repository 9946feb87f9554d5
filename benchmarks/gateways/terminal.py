"""What programs say in a terminal, and a picture of it."""

import html
import io
import subprocess
import sys
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser

COLUMNS = 118
COLOURS = 32
"""Of a picture in the repository; text needs no more."""
LONGEST_S = 120
LINE_ENDS = "\x1eline\x1e"
"""Printed between what the lines of a session say."""

PYTHON = f"""
import code, sys
console = code.InteractiveConsole()
for line in sys.argv[1:]:
    console.push(line)
    print({LINE_ENDS!r}, flush=True)
"""

PAGE = """<body style="margin: 0"><pre style="margin: 0; padding: 18px; width: max-content;
background: #15191e; color: #e6e6e6; font: 16px/1.35 'DejaVu Sans Mono', monospace">{text}</pre></body>"""


@dataclass(frozen=True, slots=True)
class Said:
    """A command with its prompt, and what the program said to it."""

    command: str
    answer: str
    prompt: str = "$ "


def run(command: Sequence[str], *, shown: str, environment: dict[str, str] | None = None) -> Said:
    """Run a command; tell it as `shown`. Raises CalledProcessError."""
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=LONGEST_S, env=environment
    )
    return Said(shown, done.stdout)


def python_session(
    title: str, lines: Sequence[str], *, before: Sequence[str] = (), hidden: Sequence[str] = ()
) -> list[Said]:
    """Type lines into Python. before: lines that are typed first, and not told. hidden: lines among them."""
    every = [*before, *lines]
    done = subprocess.run(
        [sys.executable, "-c", PYTHON, *every], capture_output=True, text=True, check=True, timeout=LONGEST_S
    )
    answers = [one.strip("\n") for one in done.stdout.split(f"{LINE_ENDS}\n")]
    assert "Traceback" not in done.stderr, done.stderr
    assert len(answers) == len(every) + 1, done.stderr
    told = zip(every[len(before) :], answers[len(before) :], strict=False)
    return [
        Said(f"python   # {title}", ""),
        *(Said(line, answer, ">>> ") for line, answer in told if line not in hidden),
    ]


def octave_session(octave: str, lines: Sequence[str], *, before: Sequence[str] = ()) -> list[Said]:
    """Type lines into GNU Octave. before: statements that are typed first, and not told."""
    every = [*before, *lines]
    words = "\n".join(f"{line}\nprintf('{LINE_ENDS}\\n');" for line in every)
    done = subprocess.run(
        [octave, "--no-gui", "--norc", "--quiet", "--eval", words],
        capture_output=True,
        text=True,
        check=True,
        timeout=LONGEST_S,
    )
    answers = [one.strip("\n") for one in done.stdout.split(f"{LINE_ENDS}\n")]
    told = zip(lines, answers[len(before) :], strict=False)
    return [Said("octave", ""), *(Said(line, answer, ">> ") for line, answer in told)]


def draw(browser: Browser, said: Sequence[Said], file: Path) -> None:
    """Write a picture of what was said."""
    parts = []
    for one in said:
        command = html.escape(f"{one.prompt}{one.command}")
        parts.append(f'<span style="color: #8fc7ff">{command}</span>\n')
        for line in one.answer.splitlines():
            indent = " " * (len(line) - len(line.lstrip()) + 2)
            wrapped = textwrap.wrap(line, COLUMNS, subsequent_indent=indent, drop_whitespace=False) or [""]
            parts.append(html.escape("\n".join(wrapped)) + "\n")
    page = browser.new_page(device_scale_factor=1)
    try:
        page.set_content(PAGE.format(text="".join(parts)))
        shot = page.locator("pre").screenshot()
    finally:
        page.close()
    Image.open(io.BytesIO(shot)).convert("RGB").quantize(COLOURS).save(file, optimize=True)
