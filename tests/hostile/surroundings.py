"""Whether anything was written where nothing may be: the service's data directory and all around it."""

import re
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

ALLOWED = (
    r"statorwatch\.sqlite(-wal|-shm)?",
    r"(gateway-\d+|service)\.lock",
    r"installation",
    r"visiting(/\d+(/[A-Za-z0-9_]+)?)?",
    r"recordings(/incoming(/[0-9a-z-]{1,60}(/[0-9a-f]{32})?)?)?",
    r"recordings/[0-9a-f]{2}(/[0-9a-f]{64})?",
)
"""What a service keeps in its data directory, besides the files of recordings."""

RECORDED = r"recordings/([0-9a-f]{2}/[0-9a-f]{64}|incoming/[0-9a-z-]{1,60}/[0-9a-f]{32})/([^/]+)"
LONGEST_NAME = 100


@dataclass(frozen=True)
class Snapshot:
    """Every file of a directory and what is in it, by path."""

    contents: dict[str, str]

    @classmethod
    def of(cls, directory: Path, *, without: Path | None = None) -> "Snapshot":
        return cls(
            {
                str(path.relative_to(directory)): sha256(path.read_bytes()).hexdigest()
                if path.is_file()
                else ""
                for path in directory.rglob("*")
                if without is None or not path.is_relative_to(without)
            }
        )

    def changed(self, now: "Snapshot") -> list[str]:
        """Paths that came, went or are other ones."""
        names = self.contents.keys() | now.contents.keys()
        return sorted(name for name in names if self.contents.get(name) != now.contents.get(name))


def strangers(data: Path) -> list[str]:
    """Paths in a data directory that no service makes."""
    return [name for path in sorted(data.rglob("*")) if not _belongs(name := str(path.relative_to(data)))]


def _belongs(name: str) -> bool:
    if any(re.fullmatch(pattern, name) for pattern in ALLOWED):
        return True
    recorded = re.fullmatch(RECORDED, name)
    if recorded is None:
        return False
    own = recorded[2]
    return len(own) <= LONGEST_NAME and own.isprintable() and not own.startswith(".")
