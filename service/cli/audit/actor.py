"""Who runs a command that changes the database itself, for the audit trail."""

import getpass
import os

from service.storage.records import COMMAND_LINE, Actor


def command_line_actor() -> Actor:
    """Return the user of this process, by name or, where the system has none for it, by number."""
    try:
        name = getpass.getuser()
    except (KeyError, OSError):
        name = f"user {os.getuid()}"
    return Actor(name, COMMAND_LINE)
