"""What is wrong with a TOML file of the simulator, said for people: which file, which key."""

import tomllib
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from ied_sim.errors import TableError

T = TypeVar("T", bound=TableError)


class Table(BaseModel):
    """A table of such a file: no unknown keys, no changes."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def read_table(path: Path, error: type[T]) -> dict[str, object]:
    """The file's contents. Raises `error`."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as reason:
        raise error(
            path, "file", expected="a readable file", found=reason.strerror or str(reason)
        ) from reason
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as reason:
        raise error(path, "file", expected="TOML in UTF-8", found=str(reason)) from reason


def first_error(path: Path, place: str, invalid: ValidationError, error: type[T]) -> T:
    """The first of pydantic's complaints as `error`; `place` is where in the file it is."""
    first = invalid.errors()[0]
    if first["type"] == "missing":
        return error(path, place, expected="this field", found="nothing")
    if first["type"] == "extra_forbidden":
        return error(path, place, expected="no such field", found="one; is the name right?")
    expected = first["msg"].removeprefix("Value error, ").removeprefix("Input should be ")
    return error(path, place, expected=expected, found=repr(first["input"])[:80])
