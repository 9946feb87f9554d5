"""Tie a worker process to the service it belongs to."""

import multiprocessing
import os
import signal
import threading
from multiprocessing.connection import wait

from service.process.termination import leave_to_parent


def follow_service() -> None:
    """End this worker when the service says so, or with the service."""
    leave_to_parent(signal.SIGINT)  # Ctrl-C reaches the whole process group
    service = multiprocessing.parent_process()
    if service is None:
        raise RuntimeError("this is no worker process: it has no parent among Python's processes")
    threading.Thread(target=_end_with, args=(service.sentinel,), name="service-watch", daemon=True).start()


def _end_with(sentinel: int) -> None:
    """End this process when that of the sentinel has ended."""
    wait([sentinel])
    os._exit(1)  # whatever the worker computes now, nobody is left to take it
