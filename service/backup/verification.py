"""Verifies a back-up: every file is there, is no more, and has the hash that was written down."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

from service.backup.errors import BackupError
from service.backup.layout import (
    CONFIGURATION,
    DATABASE_FILE,
    DATABASE_FOLDER,
    MANIFEST,
    POOL,
    ListedFile,
    backups_in,
    hash_of,
    locked,
    require_mark,
)
from service.backup.manifest import Manifest, read_manifest, read_sums
from service.backup.sqlite_reading import digests_of, sqlite_opened
from service.recording_store.contents import StoredFile, manifest_digest

MOST_TOLD = 20
"""Problems that a message names."""


@dataclass(frozen=True, slots=True)
class Verified:
    """A back-up with what is wrong with it; nothing where it is whole."""

    directory: Path
    manifest: Manifest
    files: tuple[ListedFile, ...]
    problems: tuple[str, ...]

    @property
    def digests(self) -> frozenset[str]:
        """The recordings that it lists."""
        return frozenset(file.digest for file in self.files if file.digest is not None)

    def require_whole(self) -> None:
        """Raise BackupError where anything is wrong."""
        if self.problems:
            more = len(self.problems) - MOST_TOLD
            told = "; ".join(self.problems[:MOST_TOLD]) + (f"; and {more} more" if more > 0 else "")
            raise BackupError(f"{self.directory / self.manifest.name}: this back-up is not whole: {told}")


def found_backup(path: Path) -> tuple[Path, str]:
    """Return directory and name of a back-up: the one at the path, or the latest one below it.

    Raises BackupError.
    """
    if (path / MANIFEST).is_file():
        absolute = path.absolute()
        require_mark(absolute.parent)
        return absolute.parent, absolute.name
    names = backups_in(path)
    if not names:
        raise BackupError(f"{path}: expected a back-up, found none")
    return path.absolute(), names[-1]


def verify_backup(path: Path) -> Verified:
    """Read every file of a back-up. Raises BackupError where its manifest or its list cannot be used."""
    directory, name = found_backup(path)
    with locked(directory):
        return verified(directory, name)


def verified(directory: Path, name: str) -> Verified:
    """Do the same, where the directory is locked already."""
    manifest = read_manifest(directory, name)
    files = tuple(read_sums(directory, name))
    return Verified(directory, manifest, files, tuple(_problems(directory, name, manifest, files)))


def _problems(directory: Path, name: str, manifest: Manifest, files: tuple[ListedFile, ...]) -> Iterator[str]:
    size_bytes = 0
    recordings: dict[str, list[StoredFile]] = {}
    whole: set[str] = set()
    for file in files:
        try:
            found, of_file = hash_of(directory, file.path)
        except BackupError as error:
            yield str(error)
            continue
        size_bytes += of_file
        if found == file.sha256:
            whole.add(file.path)
        else:
            yield f"{file.path}: expected SHA-256 {file.sha256}, found {found}"
        if file.digest is not None:
            recordings.setdefault(file.digest, []).append(StoredFile(file.file_name, of_file, found))
    for digest, stored in recordings.items():
        if manifest_digest(tuple(stored)) != digest:
            yield f"{POOL}/{digest[:2]}/{digest}: its files are not those of this recording"
    yield from _wrong_numbers(manifest, files, size_bytes)
    if f"{name}/{DATABASE_FILE}" in whole:
        yield from _wrong_database(directory / name / DATABASE_FILE, manifest, recordings.keys())


def _wrong_numbers(manifest: Manifest, files: tuple[ListedFile, ...], size_bytes: int) -> Iterator[str]:
    digests = {file.digest for file in files if file.digest is not None}
    own = {file.path.partition("/")[2] for file in files if file.digest is None}
    expected = {f"{DATABASE_FOLDER}/{table}.copy" for table in manifest.tables} or {DATABASE_FILE}
    found = {path for path in own if not path.startswith(f"{CONFIGURATION}/")}
    if found != expected or (manifest.database == "sqlite") != (expected == {DATABASE_FILE}):
        yield f"SHA256SUMS: expected the files of a {manifest.database} database, found {sorted(found)[:5]}"
    for what, told, number in (
        ("files", manifest.files, len(files)),
        ("recordings", manifest.recordings, len(digests)),
        ("bytes", manifest.size_bytes, size_bytes),
    ):
        if told != number:
            yield f"manifest.json: expected {told} {what}, found {number}"


def _wrong_database(file: Path, manifest: Manifest, listed: Collection[str]) -> list[str]:
    try:
        with sqlite_opened(file) as copy:
            (check,) = copy.execute("PRAGMA quick_check(1)").fetchone()
            (revision,) = copy.execute("SELECT version_num FROM alembic_version").fetchone()
            missing = digests_of(copy) - set(listed) - {lost.digest for lost in manifest.lost}
    except BackupError as error:
        return [str(error)]
    problems = []
    if check != "ok":
        problems.append(f"{file.name}: expected a sound database, found: {check}")
    if revision != manifest.revision:
        problems.append(f"{file.name}: expected tables of revision {manifest.revision}, found {revision}")
    if missing:
        problems.append(f"{file.name}: {len(missing)} recordings are not in the list, such as {min(missing)}")
    return problems
