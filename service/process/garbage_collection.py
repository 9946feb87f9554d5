"""Garbage collection in short-lived commands."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collection_paused() -> Iterator[None]:
    """Pause the cyclic garbage collector.

    It runs again and again while libraries are imported, finds nothing to free there, and takes a sixth of
    the time of a command that ends within a second.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
