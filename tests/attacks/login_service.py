"""Who logs in at a service that is attacked, and with what."""

import time
from collections.abc import Callable

import httpx
import pyotp

from core.units import NANOSECONDS_PER_SECOND
from service.access.passwords import hashed
from service.access.second_factors import STEP_S
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS
from tests.service.api.serving import LONGEST_S

API = "/api/v1"
LOGIN = f"{API}/login"
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
HASH = hashed(PASSWORD)

Serve = Callable[..., httpx.Client]
"""Starts a service with these settings of [access]; returns a browser that has not logged in.

address: at which people reach it.
"""


class Clock:
    """The time of the service and of authenticator apps."""

    def __init__(self) -> None:
        self.now_ns = time.time_ns() // NANOSECONDS_PER_SECOND * NANOSECONDS_PER_SECOND

    def next_step(self) -> None:
        self.now_ns += STEP_S * NANOSECONDS_PER_SECOND

    def code(self, secret: str, steps: int = 0) -> str:
        return pyotp.TOTP(secret).at(self.now_ns // NANOSECONDS_PER_SECOND, counter_offset=steps)


def add_user(repository: Repository, name: str, *roles: Role) -> dict[str, str]:
    """Make a user with the password above; return what they log in with."""
    repository.add_user(name, roles, password=HASH, by=TESTS, now_ns=time.time_ns())
    return {"name": name, "password": PASSWORD}


def another(browser: httpx.Client) -> httpx.Client:
    """Return another browser at the same service, without cookies."""
    return httpx.Client(base_url=browser.base_url, trust_env=False, timeout=LONGEST_S)
