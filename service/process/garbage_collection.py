"""Garbage collection: less of it in short-lived commands, and none of what a service keeps for ever."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collection_paused() -> Iterator[None]:
    """Pause the cyclic garbage collector, and spare it what was made meanwhile.

    The collector runs again and again while libraries are imported, and once more when the interpreter ends.
    It finds nothing worth freeing in a command that ends within a second, and takes a quarter of its time.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if was_enabled:
            gc.enable()


def spare_what_stays() -> None:
    """Collect once, and look through nothing of what is left ever again.

    A service calls this when it has loaded what it needs. Each full collection would else look through all
    its libraries: a tenth of a second, for which one request for a long list in thirty would wait.
    """
    gc.collect()
    gc.freeze()
