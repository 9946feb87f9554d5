"""Where a command has a password from: a prompt, a file, the standard input. Never from its arguments."""

import getpass
import sys
from pathlib import Path

from service.access.passwords import MOST_BYTES
from service.cli.output import CommandError, print_warning

STANDARD_INPUT = "-"
OTHERS = 0o077


def given_password(file: str | None, prompt: str, *, again: bool) -> str:
    """Return a password: the first line of a file ("-": of the standard input), or what somebody types.

    again: have it typed twice, because nobody sees it. Raises CommandError.
    """
    if file is not None:
        return _first_line(file)
    if not sys.stdin.isatty():
        raise CommandError("expected a terminal to type the password at, found none; see --password-file")
    try:
        password = getpass.getpass(f"{prompt}: ")
        if again and getpass.getpass(f"{prompt}, again: ") != password:
            raise CommandError("the two passwords differ; nothing was changed")
    except EOFError as error:
        raise CommandError("no password was typed; nothing was changed") from error
    return password


def given_code(file: str | None, prompt: str, *, asked: bool) -> str | None:
    """Return a code of a second factor: the first line of a file, or what somebody types; None for none.

    asked: whether to ask for one where there is no file. Raises CommandError.
    """
    if file is not None:
        return _first_line(file)
    if not asked:
        return None
    sys.stderr.write(f"{prompt}: ")
    sys.stderr.flush()
    return sys.stdin.readline(MOST_BYTES).strip() or None


def _first_line(file: str) -> str:
    try:
        if file == STANDARD_INPUT:
            line = sys.stdin.readline(MOST_BYTES + 2)
        else:
            path = Path(file)
            if path.stat().st_mode & OTHERS:
                print_warning(f"{path}: others than its owner may read this password (chmod 600)")
            with path.open(encoding="utf-8") as opened:
                line = opened.readline(MOST_BYTES + 2)
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(f"{file}: expected a file with a password, found: {error}") from error
    password = line.removesuffix("\n").removesuffix("\r")
    if not password:
        raise CommandError(f"{file}: expected a password on the first line, found none")
    return password
