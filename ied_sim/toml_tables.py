"""Tables of the simulator's TOML files, and what is wrong with them in words: which file, which key."""

import tomllib
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from ied_sim.errors import TableError

T = TypeVar("T", bound=TableError)


class Table(BaseModel):
    """Base of the tables: unknown keys are refused, and nothing can be changed."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def read_table(path: Path, error: type[T]) -> dict[str, object]:
    """Read a TOML file. Raise `error` where it cannot be read."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as reason:
        raise error(
            path, "file", expected="a readable file", found=reason.strerror or str(reason)
        ) from reason
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as reason:
        raise error(path, "file", expected="TOML in UTF-8", found=str(reason)) from reason


def first_error(path: Path, place: str, invalid: ValidationError, error: type[T]) -> T:
    """Turn the first of pydantic's errors into `error`; `place` is where in the file it is."""
    first = invalid.errors()[0]
    if first["type"] == "missing":
        return error(path, place, expected="this field", found="nothing")
    if first["type"] == "extra_forbidden":
        return error(path, place, expected="no such field", found="one; is the name right?")
    expected = first["msg"].removeprefix("Value error, ").removeprefix("Input should be ")
    return error(path, place, expected=expected, found=repr(first["input"])[:80])
