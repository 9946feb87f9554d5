"""What is asked of an S3-compatible store, each with a limit of time and an error in plain words.

boto3 finds endpoint, region and credentials as every S3 client does: in the environment, in its files, from
the machine that it runs on. It is imported when the first request is made, and by nobody else.
"""

import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import Any, BinaryIO, Final

from core.error_words import one_line
from service.configuration.recordings_url import BucketPlace
from service.recording_store import endpoint
from service.recording_store.errors import RecordingStoreError, StoreError, StoreUnreachableError

CONNECT_S, ANSWER_S, ATTEMPTS = 3.0, 10.0, 2
"""Of a transfer: how long a connection, and each part of the answer, may take [s]."""
QUICK_CONNECT_S, QUICK_ANSWER_S = 2.0, 4.0
"""Of what others wait for, while a transaction of the database is open: one attempt [s]."""
TRANSFER_S, LEAST_BYTES_PER_S = 20.0, 100_000.0
"""A transfer may take so long, and what its bytes take at the slowest rate."""
CHUNK_BYTES: Final = 1 << 16
CONNECTIONS = 32
MOST_SHOWN, MOST_OF_A_CODE = 300, 60
"""Of what the library and the store say, so many characters are told."""

_GONE = "NoSuchKey"
"""A 404 without this code is a proxy's, or that of another server: no recording is at fault."""
_LIKE_AN_OUTAGE = frozenset({"NoSuchBucket", "SlowDown", "RequestTimeout", "RequestTimeTooSkewed"})


class ObjectGoneError(RecordingStoreError):
    """There is no object of this key."""


@dataclass(frozen=True, slots=True)
class StoredObject:
    """An object: its key below the place, when it was put there [s since 1970], its size [bytes]."""

    key: str
    since_s: float
    size_bytes: int


def has_boto3() -> bool:
    """Return whether the library is installed."""
    return find_spec("boto3") is not None


def require_boto3() -> None:
    """Raise StoreError where the library is not installed."""
    if not has_boto3():
        raise StoreError(
            'recordings_url: expected the library boto3, found none: pip install "statorwatch[s3]"'
        )


@lru_cache(maxsize=2)
def _client(*, quick: bool) -> Any:
    """Return a client of this process, which any thread may use. Raises StoreError, and what boto3 does."""
    import boto3
    from botocore.config import Config
    from botocore.exceptions import BotoCoreError

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
    try:
        client = boto3.session.Session().client("s3", config=config)
    except BotoCoreError:
        raise
    except ValueError:  # boto3 would tell the URL, which may have a password in it
        raise StoreUnreachableError(f"{endpoint.WANTED}, found another one") from None
    endpoint.require_sound(client.meta.endpoint_url)
    return client


def endpoint_problem() -> str | None:
    """Return what is odd about the endpoint that this process finds, or None. Nobody is asked."""
    from botocore.exceptions import BotoCoreError

    try:
        url = _client(quick=True).meta.endpoint_url
    except (StoreError, BotoCoreError) as error:
        return one_line(str(error))[:MOST_SHOWN]
    if endpoint.goes_in_clear(url):
        return (
            f"recordings go over the network in clear to {url}: give the store TLS and its endpoint https "
            "(AWS_ENDPOINT_URL_S3)"
        )
    return None


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
        with self._asking(f"reading {key}", of_an_object=True):
            answer = _client(quick=False).get_object(Bucket=self._place.bucket, Key=self._key(key))
            # The connection itself: boto3's own read waits for more than has come, and so past the limit.
            with answer["Body"] as raw:
                while left > 0 and (chunk := raw.read1(min(CHUNK_BYTES, left))):
                    _require_time(end_s)
                    digest.update(chunk)
                    sink.write(chunk)
                    left -= len(chunk)
        if left > 0 and answer.get("ContentLength", size_bytes) >= size_bytes:
            # Otherwise it is another object than was listed, which its hash tells.
            raise StoreUnreachableError(
                f"{self._place}: reading {key}: expected {size_bytes} bytes, found the connection to end "
                f"after {size_bytes - left}"
            )
        return digest.hexdigest()

    def objects(self, below: str, most: int | None = None) -> Iterator[StoredObject]:
        """Yield the objects whose keys begin so, in the order of the keys."""
        with self._asking(f"listing {below}".rstrip()):
            pages = _client(quick=True).get_paginator("list_objects_v2")
            options = {} if most is None else {"MaxItems": most, "PageSize": most}
            for page in pages.paginate(
                Bucket=self._place.bucket, Prefix=self._key(below), PaginationConfig=options
            ):
                if "Name" not in page:  # of the bucket
                    raise self._is_no_listing(below, "another answer")
                for one in page.get("Contents", ()):
                    yield self._listed(one, below)

    def delete(self, key: str) -> None:
        """Delete an object, which may be gone already."""
        with self._asking(f"deleting {key}"):
            _client(quick=True).delete_object(Bucket=self._place.bucket, Key=self._key(key))

    def copy(self, key: str, to: str) -> None:
        """Have the store copy an object. Raises also ObjectGoneError."""
        source = {"Bucket": self._place.bucket, "Key": self._key(key)}
        with self._asking(f"copying {key}", of_an_object=True):
            _client(quick=False).copy_object(Bucket=self._place.bucket, Key=self._key(to), CopySource=source)

    def _key(self, key: str) -> str:
        return self._place.prefix + key

    def _listed(self, one: dict[str, Any], below: str) -> StoredObject:
        """Return an object of a listing. Raises StoreUnreachableError where it is none of those asked for."""
        key, since, size_bytes = one.get("Key", ""), one.get("LastModified"), one.get("Size", -1)
        if not key.startswith(self._key(below)) or since is None or size_bytes < 0:
            raise self._is_no_listing(below, f"{key[:MOST_SHOWN]!r} of {size_bytes} bytes")
        return StoredObject(key[len(self._place.prefix) :], since.timestamp(), size_bytes)

    def _is_no_listing(self, below: str, found: str) -> StoreUnreachableError:
        return StoreUnreachableError(
            f"{self._place}: listing {below}: expected keys below it, with times and sizes, from an "
            f"S3-compatible store, found {found}: is the endpoint right (AWS_ENDPOINT_URL_S3)?"
        )

    @contextmanager
    def _asking(self, what: str, *, of_an_object: bool = False) -> Iterator[None]:
        """Turn errors of the library into ours; of_an_object: which may be gone."""
        require_boto3()
        from botocore import exceptions
        from botocore.parsers import ResponseParserError
        from urllib3.exceptions import HTTPError

        about = f"{self._place}: {what}"
        try:
            yield
        except exceptions.ClientError as error:
            if of_an_object and error.response.get("Error", {}).get("Code") == _GONE:
                raise ObjectGoneError(f"{about}: expected an object, found none") from error
            raise self._refused(about, error.response) from error
        except exceptions.NoCredentialsError as error:
            forget_clients()  # they may be there by the next request
            raise StoreUnreachableError(
                f"{about}: expected credentials such as AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or a "
                "profile, found none"
            ) from error
        except (exceptions.ConnectionError, exceptions.HTTPClientError, HTTPError) as error:
            raise StoreUnreachableError(f"{about}: the store does not answer: {_reason(error)}") from error
        except ResponseParserError as error:
            raise StoreUnreachableError(
                f"{about}: expected the answer of an S3-compatible store, found another one: is the endpoint "
                "right (AWS_ENDPOINT_URL_S3)?"
            ) from error
        except exceptions.BotoCoreError as error:  # a profile, a region, a listing without an end
            forget_clients()
            raise StoreUnreachableError(f"{about}: the store cannot be asked: {_reason(error)}") from error

    def _refused(self, about: str, answer: dict[str, Any]) -> StoreError:
        code = one_line(str(answer.get("Error", {}).get("Code", "unknown")))[:MOST_OF_A_CODE]
        status = int(answer.get("ResponseMetadata", {}).get("HTTPStatusCode", 0))
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
        is_outage = status == 404 or status >= 500 or code in _LIKE_AN_OUTAGE
        kind = StoreUnreachableError if is_outage else StoreError
        return kind(f"{about}: the store answers {status} {code}")


def _reason(error: Exception) -> str:
    """Return the library's words on one line, without the query of a URL, and the system's if it has some."""
    words = re.sub(r"\?[^\s\"']*", "", one_line(str(error)))[:MOST_SHOWN]
    cause = getattr(getattr(error, "kwargs", {}).get("error"), "__cause__", None)
    system = cause.strerror if isinstance(cause, OSError) else None
    return f"{words} ({system})" if system else words


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
