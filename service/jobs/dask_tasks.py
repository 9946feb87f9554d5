"""What a worker of Dask does for the service: bytes in, a text of JSON out.

What it imports for that, it imports when it is asked: the process that gives out the tasks names these
functions and needs none of it.
"""

import json
import os
import pickle
import platform
from importlib.metadata import version
from threading import Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from service.jobs.task import Outcome

PACKAGES = ("statorwatch", "numpy", "scipy", "numba")
"""The same versions give the same results."""

MOST_CHARACTERS = 8 * 1024**2
"""Of the text of one outcome; those of real records have some ten thousand."""


def answer_task(work: bytes, timeout_s: float) -> str:
    """Do a task, and return what came of it; the process ends where that takes too long.

    work: a function and its argument, pickled by the service.
    """
    from service.jobs.plain import outcome_text

    limit = Timer(timeout_s, os._exit, args=(1,))
    limit.daemon = True
    limit.start()
    try:
        return outcome_text(lambda: _done(work))
    finally:
        limit.cancel()


def describe_worker(store: bytes) -> str:
    """Return the software of a worker, and why it does not see the recordings (None: it does).

    store: the store of the recordings, pickled by the service.
    """
    problem = pickle.loads(store).problem()  # noqa: S301 - of the service, whose work this is
    return json.dumps({"software": software(), "problem": problem})


def software() -> list[str]:
    """Return the versions that results depend on."""
    return [f"Python {platform.python_version()}", *(f"{name} {version(name)}" for name in PACKAGES)]


def _done(work: bytes) -> "Outcome":
    function, task = pickle.loads(work)  # noqa: S301 - of the service, whose work this is
    outcome: Outcome = function(task)
    return outcome
