"""Errors in the plant's files."""

from pathlib import Path


class PlantError(ValueError):
    """The plant's files cannot be used; it says which file and field, and what was expected and found."""

    def __init__(self, path: Path, field: str, *, expected: str, found: str) -> None:
        self.path = path
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{path}: {field}: expected {expected}, found {found}")
