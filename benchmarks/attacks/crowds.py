"""Crowds: two thousand requests that come at once, each on a connection of its own.

Each answer is counted by its status; `closed` is a connection that the service closed without one. What is no
JSON of the API or no problem document (RFC 9457) counts as `other`, and there should be none.
"""

import asyncio
import json
from collections import Counter
from collections.abc import Sequence
from functools import partial

from benchmarks.attacks.attack import Attack, Statuses, Target

CROWD = 2000
ANSWER_LIMIT_S = 60.0
PROBLEM = b"application/problem+json"


def _request(method: str, path: str, *header: str, body: bytes = b"") -> bytes:
    lines = [f"{method} {path} HTTP/1.1", "Host: 127.0.0.1", "Connection: close", *header]
    if body:
        lines += ["Content-Type: application/json", f"Content-Length: {len(body)}"]
    return "\r\n".join([*lines, "", ""]).encode() + body


WRONG_TOKEN = "Authorization: Bearer mcc_" + "A" * 43
WRONG_COOKIE = "Cookie: statorwatch_session=" + "A" * 43
LOGIN = json.dumps({"name": "admin", "password": "guessed at random"}).encode()

REQUESTS: dict[str, Sequence[bytes]] = {
    "health": (_request("GET", "/healthz"),),
    "motors, nobody says who they are": (_request("GET", "/api/v1/motors"),),
    "motors, a forged token": (_request("GET", "/api/v1/motors", WRONG_TOKEN),),
    "motors, a forged cookie": (_request("GET", "/api/v1/motors", WRONG_COOKIE),),
    "recording requests, a forged token": (
        _request("POST", "/api/v1/motors/PUMP-A1/event-reports", WRONG_TOKEN),
    ),
    "logins with a guessed password": (_request("POST", "/api/v1/login", body=LOGIN),),
    "of everything": (
        _request("GET", "/healthz"),
        _request("GET", "/api/v1/motors"),
        _request("GET", "/api/v1/openapi.json", WRONG_TOKEN),
        _request("POST", "/api/v1/login", body=LOGIN),
        _request("POST", "/api/v1/recordings", WRONG_TOKEN, body=b"x" * 9000),
        _request("DELETE", "/api/v1/recordings/x", "Origin: https://evil.example"),
        _request("GET", "/nothing/here"),
        b"\x16\x03\x01\x02\x00 no HTTP\r\n\r\n",
    ),
}


def crowd(target: Target, requests: Sequence[bytes], number: int = CROWD) -> Statuses:
    """Send so many requests at once, one after the other of those given, and count the answers."""

    async def send_all() -> Statuses:
        wanted = [requests[index % len(requests)] for index in range(number)]
        return Counter(await asyncio.gather(*(_answer(target, one) for one in wanted)))

    return asyncio.run(send_all())


async def _answer(target: Target, request: bytes) -> str:
    try:
        async with asyncio.timeout(ANSWER_LIMIT_S):
            reader, writer = await asyncio.open_connection(target.host, target.port)
            try:
                writer.write(request)
                return _kind(await reader.read(-1))
            finally:
                writer.transport.abort()
    except TimeoutError:
        return "timeout"
    except OSError:
        return "closed"


def _kind(answer: bytes) -> str:
    """Return the status of an answer; what has another form than the API's is `other`."""
    if not answer:
        return "closed"
    head, _, body = answer.partition(b"\r\n\r\n")
    status = head.split(b" ", 2)[1].decode() if head.startswith(b"HTTP/1.1 ") else "other"
    if not status.startswith("2") and (PROBLEM not in head or not body.strip().endswith(b"}")):
        return f"{status} other"
    return status


ATTACKS = tuple(
    Attack(f"{CROWD:,} at once: {name}", partial(crowd, requests=requests))
    for name, requests in REQUESTS.items()
)
