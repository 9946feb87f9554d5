"""When the certificates end that a connection with a relay needs."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from mms import CredentialFileError, read_certificates
from service.configuration.certificate_files import certificate_files_of
from service.configuration.relay_access import RelayAccess


@dataclass(frozen=True, slots=True)
class CertificateEnd:
    """A file with certificates, and when the first of them ends; `problem` where it cannot be read."""

    path: Path
    ends_ns: int | None
    problem: str | None = None

    def left_days(self, now_ns: int) -> float | None:
        """Return for how many days it lasts; below 0 where it has ended."""
        return None if self.ends_ns is None else (self.ends_ns - now_ns) / NANOSECONDS_PER_DAY


def certificate_ends(access: RelayAccess | None) -> Sequence[CertificateEnd]:
    """Return the files of a relay's table in the settings, the first to end, or not to be read, first."""
    found = [] if access is None else [certificate_end(path) for path in certificate_files_of(access)]
    return sorted(found, key=first_to_end)


def first_to_end(one: CertificateEnd) -> tuple[bool, int, str]:
    """Return the key by which files are sorted: those that cannot be read first, then by their end."""
    return one.ends_ns is not None, one.ends_ns or 0, str(one.path)


def certificate_end(path: Path) -> CertificateEnd:
    """Return when a file ends, or why it cannot be read."""
    try:
        about = path.stat()
        return CertificateEnd(path, _first_end_ns(path, about.st_mtime_ns, about.st_size))
    except (CredentialFileError, OSError, ValueError) as error:
        return CertificateEnd(path, None, str(error))


@lru_cache(maxsize=2000)
def _first_end_ns(path: Path, _changed_ns: int, _size: int) -> int:
    """Return when the first certificate of a file ends; the file is read again once it was changed."""
    ends = min(one.not_valid_after_utc for one in read_certificates(path))
    return round(ends.timestamp()) * NANOSECONDS_PER_SECOND
