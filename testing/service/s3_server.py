"""An S3-compatible server (moto's) as a process of its own, which can be told to fail as real ones do.

`python -m testing.service.s3_server PORT FAULT_FILE` serves; the file says how it fails, and an empty one
that it does not.
"""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs
from urllib.request import urlopen

from testing.ports import LOOPBACK, free_port
from testing.waiting import wait_until

BUCKET = "recordings"
SECRET = "a secret of the tests"  # noqa: S105 - nobody's
START_LIMIT_S = 120.0
ERROR = "<?xml version='1.0'?><Error><Code>{code}</Code><Message>as told</Message></Error>"
READY = "/moto-api/"
LONGEST_STALL_S = 60.0
TRICKLE_S = 0.05

Application = Callable[[Mapping[str, Any], Callable[..., Any]], Iterable[bytes]]


class Fault(StrEnum):
    """How the server fails."""

    NONE = ""
    BUSY = "503"
    DENIED = "denied"
    STALLS = "stalls"
    TRICKLES = "trickles"
    """As it sends objects; its listings come at once."""
    IS_A_PAGE = "a page"
    IS_NO_XML = "no xml"
    IS_NOT_THERE = "404"
    LISTS_OTHERS = "others"
    LISTS_NEGATIVE_SIZES = "negative sizes"


LISTING = (
    "<ListBucketResult><Name>recordings</Name><KeyCount>1</KeyCount><Contents><Key>{key}</Key>"
    "<LastModified>2026-01-01T00:00:00Z</LastModified><Size>{size}</Size></Contents></ListBucketResult>"
)
NONSENSE: Mapping[Fault, Callable[[str], tuple[str, str]]] = {
    Fault.IS_A_PAGE: lambda _: ("200 OK", "<html>it works</html>"),
    Fault.IS_NO_XML: lambda _: ("200 OK", "it works"),
    Fault.IS_NOT_THERE: lambda _: ("404 Not Found", "<html>nothing here</html>"),
    Fault.LISTS_OTHERS: lambda _: ("200 OK", LISTING.format(key="elsewhere/E.CFG", size=5)),
    Fault.LISTS_NEGATIVE_SIZES: lambda below: ("200 OK", LISTING.format(key=f"{below}E.CFG", size=-5)),
}
"""What one answers to everything that is no S3-compatible store, or one with somebody inside; the key
prefix that is asked for is known to it."""


class S3Server:
    """A server of one bucket. It can be killed and started again, empty, at the same address."""

    def __init__(self, directory: Path) -> None:
        self._faults = directory / "s3-fault"
        self._log = directory / "s3.log"
        self._port = free_port()
        self._process: subprocess.Popen[bytes] | None = None
        self.fail(Fault.NONE)

    @property
    def url(self) -> str:
        return f"http://{LOOPBACK}:{self._port}"

    @property
    def environment(self) -> Mapping[str, str]:
        """What tells a client, as every S3 client is told, where the server is and who asks."""
        return {
            "AWS_ENDPOINT_URL_S3": self.url,
            "AWS_ACCESS_KEY_ID": "tests",
            "AWS_SECRET_ACCESS_KEY": SECRET,
            "AWS_DEFAULT_REGION": "us-east-1",
            "AWS_CONFIG_FILE": os.devnull,
            "AWS_SHARED_CREDENTIALS_FILE": os.devnull,
            "AWS_EC2_METADATA_DISABLED": "true",
        }

    def start(self) -> None:
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "testing.service.s3_server", str(self._port), str(self._faults)],
                stdout=log,
                stderr=log,
            )
        wait_until(self._answers, within_s=START_LIMIT_S)

    def make_bucket(self, name: str = BUCKET) -> None:
        self.client().create_bucket(Bucket=name)

    def client(self) -> Any:
        """A client of the test's own, to look and to do damage."""
        return self._client

    @cached_property
    def _client(self) -> Any:
        import boto3

        return boto3.client(
            "s3",
            endpoint_url=self.url,
            aws_access_key_id="tests",
            aws_secret_access_key=SECRET,
            region_name="us-east-1",
        )

    def keys_of(self, bucket: str = BUCKET) -> list[str]:
        return [one["Key"] for one in self.client().list_objects_v2(Bucket=bucket).get("Contents", ())]

    def fail(self, fault: Fault) -> None:
        self._faults.write_text(fault)

    def kill(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None

    def _answers(self) -> bool:
        assert self._process is not None
        assert self._process.poll() is None, self._log.read_text()
        try:
            with urlopen(self.url + READY, timeout=5.0) as answer:  # noqa: S310 - our own server
                return int(answer.status) == 200
        except OSError:
            return False


@contextmanager
def serving_s3(directory: Path) -> Iterator[S3Server]:
    """A server that runs, with the bucket."""
    server = S3Server(directory)
    try:
        server.start()
        server.make_bucket()
        yield server
    finally:
        server.kill()


def failing(application: Application, faults: Path) -> Application:
    """The application behind a door that fails as the file says."""

    def answer(environment: Mapping[str, Any], start: Callable[..., Any]) -> Iterable[bytes]:
        if environment["PATH_INFO"].startswith(READY):
            return application(environment, start)
        fault = Fault(faults.read_text())
        match fault:
            case Fault.BUSY:
                return _error("503 Slow Down", "SlowDown", start)
            case Fault.DENIED:
                return _error("403 Forbidden", "AccessDenied", start)
            case Fault.STALLS:
                end_s = time.monotonic() + LONGEST_STALL_S
                while Fault(faults.read_text()) is Fault.STALLS and time.monotonic() < end_s:
                    time.sleep(0.05)
            case Fault.TRICKLES if "list-type" not in environment["QUERY_STRING"]:
                return _slowly(application(environment, start))
            case _ if fault in NONSENSE:
                asked = parse_qs(environment["QUERY_STRING"]).get("prefix", [""])[0]
                status, body = NONSENSE[fault](asked)
                start(status, [("Content-Type", "application/xml")])
                return [body.encode()]
        return application(environment, start)

    return answer


def _error(status: str, code: str, start: Callable[..., Any]) -> Iterable[bytes]:
    start(status, [("Content-Type", "application/xml")])
    return [ERROR.format(code=code).encode()]


def _slowly(body: Iterable[bytes]) -> Iterator[bytes]:
    for chunk in body:
        for at in range(len(chunk)):
            yield chunk[at : at + 1]
            time.sleep(TRICKLE_S)


def main() -> None:
    """Serve until killed."""
    from moto.moto_server.werkzeug_app import DomainDispatcherApplication, create_backend_app
    from werkzeug.serving import run_simple

    port, faults = int(sys.argv[1]), Path(sys.argv[2])
    application = failing(DomainDispatcherApplication(create_backend_app), faults)
    run_simple(LOOPBACK, port, application, threaded=True)


if __name__ == "__main__":
    main()
