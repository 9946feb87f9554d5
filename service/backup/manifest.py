"""The manifest of a back-up: what it is a back-up of, and the hash of the list of its files."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from service.backup.errors import BackupError
from service.backup.layout import MANIFEST, SUMS, ListedFile, create, hash_of, is_path_of, opened

FORMAT = 1
MOST_MANIFEST_BYTES = 16 << 20
MOST_LINE_BYTES = 512

Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
Count = Annotated[int, Field(ge=0, le=2**62)]
ColumnName = Annotated[str, Field(pattern="^[A-Za-z_][A-Za-z0-9_]{0,62}$")]
TableName = Annotated[str, Field(pattern="^[a-z][a-z0-9_]{0,62}$")]

_LINE = re.compile(r"([0-9a-f]{64})  ([\x21-\x7e]{1,400})\n")


class TableCopy(BaseModel):
    """A table of PostgreSQL as it was copied: its columns in their order, and how many rows it has."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    columns: list[ColumnName] = Field(max_length=200)
    rows: Count


class Lost(BaseModel):
    """A recording whose files were missing or damaged already when the back-up was made."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    digest: Sha256
    problem: str = Field(max_length=1000)


class Manifest(BaseModel):
    """What a back-up is. made: RFC 3339.  sums: the SHA-256 of its SHA256SUMS.

    revision: that of the tables.  tables: of PostgreSQL; empty for SQLite.  lost: what it cannot have.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    format: int
    name: str = Field(max_length=100)
    made: str = Field(max_length=40)
    program: str = Field(max_length=100)
    database: Literal["sqlite", "postgresql"]
    revision: str = Field(pattern="^[0-9A-Za-z_]{1,32}$")
    recordings: Count
    files: Count
    size_bytes: Count
    sums: Sha256
    tables: dict[TableName, TableCopy] = Field(default_factory=dict, max_length=500)
    lost: list[Lost] = Field(default_factory=list, max_length=100_000)


def write_sums(folder: Path, files: Iterable[ListedFile]) -> str:
    """Write the list of files; return its SHA-256."""
    with create(folder / SUMS) as sums:
        for file in files:
            sums.write(f"{file.sha256}  {file.path}\n".encode("ascii"))
    return hash_of(folder, SUMS)[0]


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Write the manifest, as the last file of a back-up."""
    with create(folder / MANIFEST) as file:
        file.write(json.dumps(manifest.model_dump(), indent=2).encode() + b"\n")


def read_manifest(directory: Path, name: str) -> Manifest:
    """Read the manifest of a back-up, and see that its list of files is the one it tells of.

    Raises BackupError.
    """
    where = directory / name / MANIFEST
    with opened(directory, f"{name}/{MANIFEST}") as file:
        text = file.read(MOST_MANIFEST_BYTES + 1)
    if len(text) > MOST_MANIFEST_BYTES:
        raise BackupError(f"{where}: expected at most {MOST_MANIFEST_BYTES} bytes, found more")
    found: object = _json(text, where)
    told = found.get("format") if isinstance(found, Mapping) else None
    if isinstance(told, int) and told > FORMAT:
        raise BackupError(
            f"{where}: expected format {FORMAT} or older, found {told}: a newer version made this back-up; "
            "restore it with that version"
        )
    try:
        manifest = Manifest.model_validate(found)
    except ValidationError as error:
        details = error.errors(include_url=False)[0]
        field = ".".join(map(str, details["loc"])) or "document"
        raise BackupError(f"{where}: {field}: {details['msg']}") from error
    if manifest.name != name:
        raise BackupError(f"{where}: name: expected {name}, as its folder is called, found {manifest.name!r}")
    sums, _ = hash_of(directory, f"{name}/{SUMS}")
    if sums != manifest.sums:
        raise BackupError(
            f"{directory / name / SUMS}: expected SHA-256 {manifest.sums}, as the manifest says, found {sums}"
        )
    return manifest


def read_sums(directory: Path, name: str) -> Iterator[ListedFile]:
    """Yield the files of a back-up, each once. Raises BackupError (a path that leads elsewhere, no list)."""
    where = directory / name / SUMS
    seen: set[str] = set()
    with opened(directory, f"{name}/{SUMS}") as file:
        while line := file.readline(MOST_LINE_BYTES + 1):
            match = _LINE.fullmatch(line.decode("ascii", errors="replace"))
            if match is None:
                raise BackupError(
                    f"{where}: line {len(seen) + 1}: expected a SHA-256 and a path, found {line[:80]!r}"
                )
            if not is_path_of(match[2], name):
                raise BackupError(
                    f"{where}: line {len(seen) + 1}: expected a path of this back-up or of a recording, "
                    f"found {match[2][:120]!r}"
                )
            if match[2] in seen:
                raise BackupError(f"{where}: line {len(seen) + 1}: {match[2]} is listed twice")
            seen.add(match[2])
            yield ListedFile(match[2], match[1])


def _json(text: bytes, where: Path) -> object:
    try:
        found: object = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise BackupError(f"{where}: expected a JSON document, found: {error}") from error
    return found
