"""Prepare a worker process, and tie it to the service it belongs to."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from multiprocessing.connection import wait
from multiprocessing.synchronize import Semaphore
from typing import Final

from pebble import CONSTS

from service.process.capabilities import keep_only
from service.process.termination import leave_to_parent

NICENESS: Final = 5
"""Records are fetched first: a relay may overwrite what nobody has fetched, and a diagnosis can wait."""

LOCK_TIMEOUT_S: Final = 10.0
"""How long a worker waits for the pipe that all share.

One that is killed while it has the pipe keeps it locked, and nothing is diagnosed until all others have given
up twice. The library waits for a minute each time.
"""


def prepare(prepare_worker: Callable[[], None], prepared: Semaphore) -> None:
    """Prepare a worker, in that worker; tell the pool when it is done."""
    # It reads what relays send, and needs no right but its user's.
    keep_only([])
    os.nice(NICENESS)
    CONSTS.channel_lock_timeout = LOCK_TIMEOUT_S
    prepare_worker()
    prepared.release()


LOOK_S: Final = 1.0
"""How often a worker looks whether the process that it was forked from is still there."""


def follow_service() -> None:
    """End this worker when the service says so, or with the service, or with the parent of the workers."""
    leave_to_parent(signal.SIGINT)  # Ctrl-C reaches the whole process group
    service = multiprocessing.parent_process()
    if service is None:
        raise RuntimeError("this is no worker process: it has no parent among Python's processes")
    threading.Thread(
        target=_end_with, args=(service.sentinel, os.getppid()), name="service-watch", daemon=True
    ).start()


def _end_with(sentinel: int, parent: int) -> None:
    """End this process when that of the sentinel has ended, or another one has become its parent.

    Without the parent the service does not hear of this process, and takes it for ended.
    """
    while not wait([sentinel], LOOK_S) and os.getppid() == parent:
        pass
    os._exit(1)  # whatever the worker computes now, nobody is left to take it
