"""Errors in the plant's files."""

from pathlib import Path

from service.configuration.problems import ConfigurationError, Problem


class PlantError(ConfigurationError):
    """The plant's files cannot be used; it says which file and field, and what was expected and found."""


def plant_error(
    path: Path, field: str, *, expected: str, found: str, nearest: str | None = None
) -> PlantError:
    """Return the error of one problem in a file."""
    return PlantError([Problem(str(path), field, expected, found, nearest)])
