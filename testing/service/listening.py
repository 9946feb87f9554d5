"""An ASGI application on a real server at a free port of the loopback."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from fastapi import FastAPI
from starlette.types import ASGIApp

from service.api.access.certificate import ServerCertificate
from service.api.limits.connections import ConnectionLimits
from service.api.server import ApiServer
from service.web.app import end_streams

LONGEST_S = 30.0
"""Time for an answer or a start on a machine that does much else; no test of speed."""


@contextmanager
def listening(
    app: ASGIApp, limits: ConnectionLimits, certificate: ServerCertificate | None = None, *, port: int = 0
) -> Iterator[int]:
    """The port at which an application is served, with TLS where there is a certificate. port: 0 for any."""
    with socket.socket() as listener:
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as the service's own
        listener.bind(("127.0.0.1", port))
        port = listener.getsockname()[1]
        server = ApiServer(app, limits, certificate=certificate, on_shutdown=_end_of(app))
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


def _end_of(app: ASGIApp) -> Callable[[], None] | None:
    """Return what ends the streams of an application that has open pages, as the service does."""
    if isinstance(app, FastAPI) and hasattr(app.state, "live"):
        return partial(end_streams, app)
    return None
