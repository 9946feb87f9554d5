"""The API on a real server at a free port of the loopback, and a client for it."""

from collections.abc import Iterator
from contextlib import contextmanager

import httpx
from fastapi import FastAPI

from service.api.server import connection_limits
from service.client.credentials import bearer
from testing.service.accounts import log_in
from testing.service.listening import LONGEST_S, listening

__all__ = ["LONGEST_S", "listening", "serving"]


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
