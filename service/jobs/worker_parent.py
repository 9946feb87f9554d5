"""Loaded by the process that all workers are forked from, before the first of them.

Its import is what it is for: multiprocessing's fork server imports it, and then only waits for requests. What
it leaves in memory is in every worker from the start, and shared while nobody writes to it.
"""

import os
import sys
import threading
from multiprocessing import forkserver
from typing import Final

from sqlalchemy.orm import configure_mappers

from service.process.capabilities import keep_only
from service.process.garbage_collection import spare_what_stays

LOOK_S: Final = 0.5
"""How often it is looked whether the service is still there. Machine code may be compiled for minutes."""


def load() -> None:
    """Load what workers need, unless the service ends meanwhile.

    No thread of this process may be left then: a fork has only the one that forks.
    """
    # Workers read what relays send, and need no right but their user's.
    keep_only([])
    loaded = threading.Event()
    watch = threading.Thread(target=_end_with, args=(os.getppid(), loaded), name="service-watch", daemon=True)
    watch.start()
    _load_all()
    loaded.set()
    watch.join()


def _load_all() -> None:
    # What the modules of the workers' tasks import only where the work is done.
    import service.condition.folding
    import service.condition.worker
    import service.jobs.worker  # noqa: F401
    from core.warm_up import warm_up

    warm_up()
    configure_mappers()
    spare_what_stays()  # a collection would write to every page that is shared


def _end_with(service: int, loaded: threading.Event) -> None:
    """End this process where another one has become its parent."""
    while not loaded.wait(LOOK_S):
        if os.getppid() != service:
            os._exit(1)


# Nowhere else: a test that imports this module keeps its rights.
if getattr(sys.modules["__main__"], "main", None) is forkserver.main:
    load()
