"""Receive StatorWatch's webhooks, and believe only those that are signed, fresh and new.

    WEBHOOK_SECRET=whsec_... python examples/webhook_receiver.py 8765

It needs Python alone. The signature is that of Standard Webhooks (https://www.standardwebhooks.com), for
which there are libraries in many languages too.
"""

import base64
import hashlib
import hmac
import json
import os
import sys
import time
from collections.abc import Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

OLDEST_S = 300.0
"""An older message may have been recorded by somebody, and sent again."""

LARGEST_BYTES = 1_000_000


class NotOursError(ValueError):
    """A request that StatorWatch has not sent, or not now."""


def key_of(secret: str) -> bytes:
    """Return the key that signs: base64 after "whsec_", else the words themselves."""
    prefix = "whsec_"
    return base64.b64decode(secret.removeprefix(prefix)) if secret.startswith(prefix) else secret.encode()


def checked(key: bytes, headers: Mapping[str, str], body: bytes, now_s: float) -> str:
    """Return the id of a message that is signed with the key and fresh. Raises NotOursError."""
    message, timestamp = headers.get("webhook-id", ""), headers.get("webhook-timestamp", "")
    if not timestamp.isascii() or not timestamp.isdecimal() or abs(now_s - int(timestamp)) > OLDEST_S:
        raise NotOursError(f"expected a time within {OLDEST_S:g} s of now, found {timestamp[:20]!r}")
    signed = hmac.digest(key, f"{message}.{timestamp}.".encode() + body, hashlib.sha256)
    expected = f"v1,{base64.b64encode(signed).decode()}"
    # Several signatures stand there while a key is replaced by another. The comparison takes as long for any.
    found = headers.get("webhook-signature", "").split(" ")
    if not any(hmac.compare_digest(one.encode(), expected.encode()) for one in found):
        raise NotOursError("expected the signature of our key, found another")
    return message


class Receiver(BaseHTTPRequestHandler):
    """Prints each message once. A second delivery of the same is answered with 204 and forgotten."""

    key = b""
    seen: set[str] = set()  # noqa: RUF012 - one for all requests; a real receiver keeps them in its database

    def do_POST(self) -> None:
        """Take one message."""
        length = int(self.headers.get("Content-Length") or 0)
        if not 0 <= length <= LARGEST_BYTES:
            self._answer(413)
            return
        body = self.rfile.read(length)
        headers = {name.lower(): value for name, value in self.headers.items()}
        try:
            message = checked(self.key, headers, body, time.time())
        except NotOursError as error:
            self.log_error("refused: %s", error)
            self._answer(401)
            return
        if message not in self.seen:
            self.seen.add(message)
            told = json.loads(body)
            print(f"{told['type']}: {told['subject']}", flush=True)
        self._answer(204)  # any 2xx says: taken, do not send it again

    def _answer(self, status: int) -> None:
        self.send_response(status)
        self.send_header("Content-Length", "0")
        self.end_headers()


def main(port: int = 8765) -> None:
    """Serve until interrupted. Behind a proxy with TLS, or on a network that is trusted."""
    Receiver.key = key_of(os.environ["WEBHOOK_SECRET"])
    with ThreadingHTTPServer(("127.0.0.1", port), Receiver) as server:
        print(f"listening at http://127.0.0.1:{server.server_port}/", flush=True)
        server.serve_forever()


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
