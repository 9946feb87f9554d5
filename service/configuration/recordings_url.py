"""Where an S3-compatible store keeps the recordings: the setting `recordings_url`."""

import re
from dataclasses import dataclass
from typing import Self

SCHEME = "s3://"
EXAMPLE = "s3://BUCKET or s3://BUCKET/PREFIX"
_BUCKET = re.compile(r"[a-z0-9][a-z0-9.-]{1,61}[a-z0-9]")
_PREFIX = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}(?:/[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}){0,9}")


@dataclass(frozen=True, slots=True)
class BucketPlace:
    """A bucket, and what the keys of all recordings begin with; empty, or ending in a slash."""

    bucket: str
    prefix: str = ""

    @classmethod
    def of(cls, url: str) -> Self:
        """Read a URL. Raises ValueError: secrets have no place in it, for it is told in logs and errors."""
        bucket, _, prefix = url.removeprefix(SCHEME).rstrip("/").partition("/")
        if not url.startswith(SCHEME) or not _BUCKET.fullmatch(bucket):
            raise ValueError(f"{EXAMPLE}, without a user, a password or a host")
        if prefix and not _PREFIX.fullmatch(prefix):
            raise ValueError(f"{EXAMPLE}, the prefix of letters, digits and . - _ between slashes")
        return cls(bucket, f"{prefix}/" if prefix else "")

    def __str__(self) -> str:
        return f"{SCHEME}{self.bucket}/{self.prefix}".rstrip("/")
