"""What the service remembers: tables, their migrations and the only code that touches them.

Names are loaded when they are used: a worker process that needs the records alone starts without the
database library; it comes with the first task that needs it.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from service.storage.engine import connect
    from service.storage.errors import (
        LeaseLostError,
        NotFoundError,
        OutOfServiceError,
        StateConflictError,
        StorageError,
    )
    from service.storage.migrations import migrate
    from service.storage.repository import Repository

__all__ = [
    "LeaseLostError",
    "NotFoundError",
    "OutOfServiceError",
    "Repository",
    "StateConflictError",
    "StorageError",
    "connect",
    "migrate",
]

_PLACES: Final = {"connect": "engine", "migrate": "migrations", "Repository": "repository"}
"""The module of each name; the others are errors."""

if not TYPE_CHECKING:  # which would take any name as there

    def __getattr__(name: str) -> object:
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(import_module(f"{__name__}.{_PLACES.get(name, 'errors')}"), name)
