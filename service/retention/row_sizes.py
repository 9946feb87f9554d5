"""How much of the database a row takes, with its part of the indexes."""

from collections.abc import Mapping
from types import MappingProxyType

ROW_BYTES: Mapping[str, int] = MappingProxyType(
    {
        "diagnoses": 6900,  # with the job
        "jobs": 400,
        "recording_requests": 470,
        "deletions": 780,  # with what the relay lists
        "measurements": 180,
    }
)
"""Mean size of a row on SQLite [bytes], measured by `python -m benchmarks.storage.growth`."""
