"""Processes that share the work of a benchmark, and end with it."""

import os
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait
from signal import SIGTERM, signal
from threading import Thread
from types import FrameType


@contextmanager
def worker_processes(number: int) -> Iterator[Executor]:
    """Open so many processes; they end when this one does, however it ends.

    Left alone, they would go on with what is queued, or wait for ever. A request to terminate raises
    SystemExit, so that everything else is cleaned up too.
    """
    exit_when_terminated()
    pool = ProcessPoolExecutor(number, mp_context=get_context("spawn"), initializer=_end_with_parent)
    try:
        yield pool
    except BaseException:
        for child in active_children():
            child.terminate()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


def exit_when_terminated() -> None:
    """Let a request to terminate raise SystemExit, so that processes and folders are cleaned up."""
    signal(SIGTERM, _exit)


def _exit(number: int, _: FrameType | None) -> None:
    sys.exit(128 + number)


def _end_with_parent() -> None:
    Thread(target=_wait_for_parent, daemon=True).start()


def _wait_for_parent() -> None:
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
