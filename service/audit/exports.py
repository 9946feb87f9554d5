"""Audit trails outside the database: lines of JSON, one an entry, and anchors read from them."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from core.time_stamps import MAX_NS, nanoseconds
from service.audit.entries import Anchor, AuditEntry

MOST_BYTES_OF_A_LINE: Final = 1 << 20
"""An entry is shorter: requests are, and texts in it are cut."""

Number = Annotated[int, Field(ge=1, le=MAX_NS)]
Hash = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class AuditFileError(ValueError):
    """A file is no export of an audit trail; says where and why."""


class _Line(BaseModel):
    """An entry as an export has it."""

    model_config = ConfigDict(strict=True, extra="forbid")

    number: Number
    time: str
    actor: str
    origin: str
    roles: str
    action: str
    subject_kind: str
    subject: str
    before: str | None
    after: str | None
    previous: str
    hash: str


class _Anchor(BaseModel):
    """The part of an entry that a chain is held against; whatever else is beside it."""

    model_config = ConfigDict(strict=True)

    number: Number
    hash: Hash


def read_export(path: Path) -> Iterator[AuditEntry]:
    """Read the entries of an export one by one. Raises AuditFileError, OSError."""
    with path.open("rb") as file:
        for number, text in enumerate(iter(lambda: file.readline(MOST_BYTES_OF_A_LINE + 1), b""), 1):
            if len(text) > MOST_BYTES_OF_A_LINE:
                raise AuditFileError(f"{path}, line {number}: longer than {MOST_BYTES_OF_A_LINE} bytes")
            try:
                yield entry_of_line(text)
            except AuditFileError as error:
                raise AuditFileError(f"{path}, line {number}: {error}") from error


def read_anchor(path: Path) -> Anchor:
    """Return the entry that the last line of a file tells, of an export or of a note of the head.

    Raises AuditFileError, OSError.
    """
    with path.open("rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - MOST_BYTES_OF_A_LINE))
        lines = file.read(MOST_BYTES_OF_A_LINE).split(b"\n")
    text = next((line for line in reversed(lines) if line.strip()), b"")
    try:
        found = _Anchor.model_validate_json(text)
    except ValidationError as error:
        raise AuditFileError(
            f"{path}: expected number and hash of an entry in the last line, as mcc audit export and mcc "
            f"audit verify --write-anchor write them; {_in_words(error)}"
        ) from error
    return Anchor(found.number, found.hash)


def entry_of_line(text: str | bytes) -> AuditEntry:
    """Return the entry that a line of an export tells. Raises AuditFileError."""
    try:
        fields = dict(_Line.model_validate_json(text))
        return AuditEntry(time_ns=nanoseconds(fields.pop("time")), **fields)
    except ValueError as error:
        raise AuditFileError(_in_words(error)) from error


def _in_words(error: ValueError) -> str:
    if not isinstance(error, ValidationError):
        return str(error)
    first = error.errors(include_input=False, include_url=False)[0]
    where = ".".join(map(str, first["loc"]))
    return f"{where}: {first['msg']}" if where else str(first["msg"])
