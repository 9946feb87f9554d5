"""The child's half of a supervised process: it gets its settings from its parent, and ends with it."""

import os
import signal
import sys
from collections.abc import Collection
from dataclasses import dataclass
from threading import Event, Thread
from typing import BinaryIO

from service.configuration.settings import Settings
from service.process.capabilities import Capability, keep_only
from service.process.logs import configure_logging
from service.process.termination import leave_to_parent


@dataclass(frozen=True, slots=True)
class ChildInput:
    """Hold what a child gets from its parent.

    parent_gone: is set when the parent has closed the pipe, however it went.  handed: bytes that the parent
    hands to each such child; none where it hands over nothing.
    """

    settings: Settings
    parent_gone: Event
    handed: bytes


def begin_child(
    process: str, settings_pipe: BinaryIO = sys.stdin.buffer, *, needs: Collection[Capability] = ()
) -> ChildInput:
    """Read what the parent hands over, and watch it from then on.

    process: names this one in the log.  needs: capabilities that it keeps where it has them; it gives up all
    others, before it has threads.
    """
    keep_only(needs)
    # They reach every process of a terminal or of a systemd unit; this one ends when the service says so.
    leave_to_parent(signal.SIGINT, signal.SIGTERM)
    settings = Settings.model_validate_json(settings_pipe.readline())
    handed = _read_all(settings_pipe.readline())
    configure_logging(process, settings.log_format)
    parent_gone = Event()
    Thread(
        target=_wait_for_end_of_input, args=(settings_pipe, parent_gone), name="parent-watch", daemon=True
    ).start()
    return ChildInput(settings, parent_gone, handed)


def _read_all(descriptor: bytes) -> bytes:
    """Return what the file holds that a line names by its inherited descriptor; nothing for an empty line."""
    if not descriptor.strip():
        return b""
    with os.fdopen(int(descriptor), "rb") as handed:
        handed.seek(0)
        return handed.read()


def _wait_for_end_of_input(pipe: BinaryIO, parent_gone: Event) -> None:
    pipe.read()
    parent_gone.set()
