"""How much of the database a row takes, with its part of the indexes."""

from collections.abc import Mapping
from types import MappingProxyType

ROW_BYTES: Mapping[str, int] = MappingProxyType(
    {
        "recordings": 900,
        "diagnoses": 3000,
        "jobs": 500,
        "recording_requests": 500,
        "deletions": 600,
        "measurements": 183,
    }
)
"""Mean size of a row on SQLite [bytes], measured: python -m benchmarks.storage.growth."""
