"""The API on a real server at a free port of the loopback, and a client for it."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
from fastapi import FastAPI
from starlette.types import ASGIApp

from service.api.access.certificate import ServerCertificate
from service.api.limits.connections import ConnectionLimits
from service.api.server import ApiServer, connection_limits
from service.client.credentials import bearer
from testing.service.accounts import log_in

LONGEST_S = 30.0
"""Time for an answer or a start on a machine that does much else; no test of speed."""


@contextmanager
def serving(app: FastAPI, *, as_somebody: bool = True) -> Iterator[httpx.Client]:
    """A client of the API, with the limits of its settings, that may do everything; so may `mcc` there.

    as_somebody: False for a client that does not say who it is.
    """
    context = app.state.context
    with listening(app, connection_limits(context.settings)) as port:
        url = f"http://127.0.0.1:{port}"
        headers = bearer(log_in(context.repository, url)) if as_somebody else {}
        with httpx.Client(base_url=url, headers=headers, trust_env=False, timeout=LONGEST_S) as client:
            yield client


@contextmanager
def listening(
    app: ASGIApp, limits: ConnectionLimits, certificate: ServerCertificate | None = None
) -> Iterator[int]:
    """The port at which an application is served, with TLS where there is a certificate."""
    with socket.socket() as listener:
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as the service's own
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
        server = ApiServer(app, limits, certificate=certificate)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            deadline = time.monotonic() + LONGEST_S
            while not server.started:
                assert time.monotonic() < deadline
                time.sleep(0.005)
            yield int(port)
        finally:
            server.should_exit = True
            thread.join(timeout=10)
    assert not thread.is_alive()
