"""What a copy of a database consists of."""

from dataclasses import dataclass, field
from typing import Literal

from service.backup.manifest import TableCopy

VERSION_TABLE = "alembic_version"


@dataclass(frozen=True, slots=True)
class DatabaseCopy:
    """What was copied: the files below the back-up's folder, and the digests of the recordings it names."""

    kind: Literal["sqlite", "postgresql"]
    revision: str
    files: tuple[str, ...]
    digests: frozenset[str]
    tables: dict[str, TableCopy] = field(default_factory=dict)
