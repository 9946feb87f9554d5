"""What an attack is, and how it talks to the service."""

import http.client
import socket
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from service.client.credentials import bearer

ANSWER_LIMIT_S = 120.0
"""An attacker gives up after so long; what the service does afterwards still counts."""

_PIECE = 1 << 16

Statuses = Counter[str]
"""How often each status came; "reset" and "timeout" where none did."""


@dataclass(frozen=True, slots=True)
class Target:
    """A service: its address and database, a token, and the recording that a preparation left there."""

    host: str
    port: int
    database: Path
    token: str
    recording: str = ""

    def ask(
        self,
        method: str,
        path: str,
        body: bytes | Iterable[bytes] | None = None,
        content_type: str = "application/json",
    ) -> str:
        """Send one request and read its answer without keeping it; an iterable body is sent in chunks."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=ANSWER_LIMIT_S)
        headers = bearer(self.token) | ({} if body is None else {"Content-Type": content_type})
        try:
            with suppress(BrokenPipeError, ConnectionResetError):  # answered before all of it was read
                connection.request(method, path, body, headers)
            answer = connection.getresponse()
            while answer.read(_PIECE):
                pass
        except TimeoutError:
            return "timeout"
        except (OSError, http.client.HTTPException):
            return "reset"
        finally:
            connection.close()
        return str(answer.status)

    def connect(self) -> socket.socket:
        """Return a plain connection."""
        return socket.create_connection((self.host, self.port), timeout=ANSWER_LIMIT_S)


@dataclass(frozen=True, slots=True)
class Attack:
    """`prepare` is done before the service is watched, and may return another target."""

    name: str
    run: Callable[[Target], Statuses]
    prepare: Callable[[Target], Target] = lambda target: target


def at_once(times: int, ask: Callable[[], str]) -> Statuses:
    """Ask so many times at the same time."""
    with ThreadPoolExecutor(times) as threads:
        return Counter(found.result() for found in [threads.submit(ask) for _ in range(times)])
