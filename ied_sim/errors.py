"""Errors of the simulator."""

from pathlib import Path


class SimulatorError(Exception):
    """The simulated plant cannot be served as asked; the message says which relay and what to do."""


class TableError(ValueError):
    """A file cannot be used; the message says which file and field, what was expected and what was found."""

    def __init__(self, path: Path | str, field: str, *, expected: str, found: str) -> None:
        self.path = Path(path)
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{self.path}: {field}: expected {expected}, found {found}")


class ScenarioError(TableError):
    """A scenario cannot be used."""


class ProfileError(TableError):
    """A relay profile cannot be used."""
