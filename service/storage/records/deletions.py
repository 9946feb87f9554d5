"""What was deleted: how much in one transaction."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class DeletedRows:
    """What one transaction deleted, and how long it had the writer to itself [s]."""

    rows: int
    took_s: float
