"""What is asked of an S3-compatible store, each with a limit of time and an error in plain words.

boto3 finds endpoint, region and credentials as every S3 client does: in the environment, in its files, from
the machine that it runs on. It is imported when the first request is made, and by nobody else.
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import Any, BinaryIO, Final

from service.configuration.recordings_url import BucketPlace
from service.recording_store.errors import RecordingStoreError, StoreError, StoreUnreachableError

CONNECT_S, ANSWER_S, ATTEMPTS = 3.0, 10.0, 2
"""Of a transfer: how long a connection, and each part of the answer, may take [s]."""
QUICK_CONNECT_S, QUICK_ANSWER_S = 2.0, 4.0
"""Of what others wait for, while a transaction of the database is open: one attempt [s]."""
TRANSFER_S, LEAST_BYTES_PER_S = 20.0, 100_000.0
"""A transfer may take so long, and what its bytes take at the slowest rate."""
CHUNK_BYTES: Final = 1 << 16
CONNECTIONS = 32

_GONE = frozenset({"NoSuchKey", "404", "NotFound"})
_LIKE_AN_OUTAGE = frozenset({"NoSuchBucket", "SlowDown", "RequestTimeout", "RequestTimeTooSkewed"})


class ObjectGoneError(RecordingStoreError):
    """There is no object of this key."""


@dataclass(frozen=True, slots=True)
class StoredObject:
    """An object: its key below the place, when it was put there [s since 1970], its size [bytes]."""

    key: str
    since_s: float
    size_bytes: int


def require_boto3() -> None:
    """Raise StoreError where the library is not installed."""
    if find_spec("boto3") is None:
        raise StoreError(
            'recordings_url: expected the library boto3, found none: pip install "statorwatch[s3]"'
        )


@lru_cache(maxsize=2)
def _client(*, quick: bool) -> Any:
    """Return a client of this process, which any thread may use. Raises what boto3 does."""
    import boto3
    from botocore.config import Config

    connect_s, answer_s = (QUICK_CONNECT_S, QUICK_ANSWER_S) if quick else (CONNECT_S, ANSWER_S)
    config = Config(
        connect_timeout=connect_s,
        read_timeout=answer_s,
        retries={"mode": "standard", "total_max_attempts": 1 if quick else ATTEMPTS},
        max_pool_connections=CONNECTIONS,
        # Every store compares what arrives with the hash that is signed; the newer checksums are not
        # everywhere understood.
        request_checksum_calculation="when_required",
        response_checksum_validation="when_required",
        s3={"payload_signing_enabled": True},
    )
    return boto3.session.Session().client("s3", config=config)


def forget_clients() -> None:
    """Look for endpoint and credentials anew at the next request."""
    _client.cache_clear()


class Bucket:
    """The objects below a place. Keys are those below its prefix. Every method raises StoreError."""

    def __init__(self, place: BucketPlace) -> None:
        self._place = place

    def put(self, key: str, path: Path) -> None:
        """Put a file there. It is seen once it is whole; the store compares it with its hash."""
        with path.open("rb") as file, self._asking(f"storing {key}"):
            body = _Timed(file, _transfer_limit_s(path.stat().st_size))
            _client(quick=False).put_object(Bucket=self._place.bucket, Key=self._key(key), Body=body)

    def get(self, key: str, size_bytes: int, sink: BinaryIO) -> str:
        """Write an object of this size to a file; return its SHA-256. Raises also ObjectGoneError."""
        digest, left = sha256(), size_bytes
        end_s = time.monotonic() + _transfer_limit_s(size_bytes)
        with self._asking(f"reading {key}"):
            answer = _client(quick=False).get_object(Bucket=self._place.bucket, Key=self._key(key))
            # The connection itself: boto3's own read waits for more than has come, and so past the limit.
            with answer["Body"] as raw:
                while left > 0 and (chunk := raw.read1(min(CHUNK_BYTES, left))):
                    _require_time(end_s)
                    digest.update(chunk)
                    sink.write(chunk)
                    left -= len(chunk)
        return digest.hexdigest()

    def objects(self, below: str, most: int | None = None) -> Iterator[StoredObject]:
        """Yield the objects whose keys begin so, in the order of the keys."""
        with self._asking(f"listing {below}"):
            pages = _client(quick=True).get_paginator("list_objects_v2")
            options = {} if most is None else {"MaxItems": most, "PageSize": most}
            first = len(self._place.prefix)
            for page in pages.paginate(
                Bucket=self._place.bucket, Prefix=self._key(below), PaginationConfig=options
            ):
                for one in page.get("Contents", ()):
                    yield StoredObject(one["Key"][first:], one["LastModified"].timestamp(), one["Size"])

    def delete(self, key: str) -> None:
        """Delete an object, which may be gone already."""
        with self._asking(f"deleting {key}"):
            _client(quick=True).delete_object(Bucket=self._place.bucket, Key=self._key(key))

    def copy(self, key: str, to: str) -> None:
        """Have the store copy an object. Raises also ObjectGoneError."""
        source = {"Bucket": self._place.bucket, "Key": self._key(key)}
        with self._asking(f"copying {key}"):
            _client(quick=False).copy_object(Bucket=self._place.bucket, Key=self._key(to), CopySource=source)

    def _key(self, key: str) -> str:
        return self._place.prefix + key

    @contextmanager
    def _asking(self, what: str) -> Iterator[None]:
        """Turn errors of the library into ours."""
        require_boto3()
        from botocore.exceptions import BotoCoreError, ClientError, NoCredentialsError
        from urllib3.exceptions import HTTPError

        try:
            yield
        except ClientError as error:
            raise self._refused(what, error.response) from error
        except NoCredentialsError as error:
            forget_clients()  # they may be there by the next request
            raise StoreUnreachableError(
                f"{self._place}: {what}: expected credentials such as AWS_ACCESS_KEY_ID and "
                "AWS_SECRET_ACCESS_KEY, or a profile, found none"
            ) from error
        except (BotoCoreError, HTTPError) as error:
            reason = " ".join(str(error).split())
            raise StoreUnreachableError(
                f"{self._place}: {what}: the store does not answer: {reason[:300]}"
            ) from error

    def _refused(self, what: str, answer: dict[str, Any]) -> OSError | RecordingStoreError:
        code = str(answer.get("Error", {}).get("Code", "unknown"))
        status = int(answer.get("ResponseMetadata", {}).get("HTTPStatusCode", 0))
        about = f"{self._place}: {what}"
        if code in _GONE:
            return ObjectGoneError(f"{about}: expected an object, found none")
        if code == "NoSuchBucket":
            return StoreUnreachableError(
                f"{about}: expected the bucket {self._place.bucket}, found none: make it, or correct "
                "recordings_url or the endpoint (AWS_ENDPOINT_URL_S3)"
            )
        if status in (401, 403) and code not in _LIKE_AN_OUTAGE:
            forget_clients()  # the credentials may have been replaced
            return StoreError(
                f"{about}: the store refuses it ({code}): expected credentials that may list, read, write "
                "and delete below this place"
            )
        kind = StoreUnreachableError if status >= 500 or code in _LIKE_AN_OUTAGE else StoreError
        return kind(f"{about}: the store answers {status} {code}")


class _Timed:
    """A file that is read for sending, and no more once the time is over."""

    def __init__(self, file: BinaryIO, limit_s: float) -> None:
        self._file = file
        self._end_s = time.monotonic() + limit_s

    def read(self, size: int = -1) -> bytes:
        _require_time(self._end_s)
        return self._file.read(size)

    def seek(self, offset: int, whence: int = 0) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()


def _transfer_limit_s(size_bytes: int) -> float:
    return TRANSFER_S + size_bytes / LEAST_BYTES_PER_S


def _require_time(end_s: float) -> None:
    if time.monotonic() > end_s:
        raise StoreUnreachableError(
            f"expected a transfer of {LEAST_BYTES_PER_S / 1000:g} kB/s at least, found a slower one: given up"
        )
