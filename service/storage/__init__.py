"""What the service remembers: tables, their migrations and the only code that touches them."""

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
