"""The API with users of each role, and clients that are one of them."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import httpx
import pytest
from fastapi import FastAPI

from service.api import ApiContext, create_app
from service.client.credentials import bearer
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import token_of
from tests.service.api.serving import LONGEST_S, serving

As = Callable[..., httpx.Client]


@pytest.fixture
def app(context: ApiContext) -> FastAPI:
    return create_app(context)


@pytest.fixture
def anonymous(app: FastAPI) -> Iterator[httpx.Client]:
    """A client that does not say who it is, of a service without users so far."""
    with serving(app, as_somebody=False) as client:
        yield client


@pytest.fixture
def as_(anonymous: httpx.Client, repository: Repository) -> Iterator[As]:
    """Clients of the same service that are users with these roles."""
    with ExitStack() as clients:

        def client(*roles: Role) -> httpx.Client:
            token = token_of(repository, *roles, name="-".join(roles).lower())
            return clients.enter_context(
                httpx.Client(
                    base_url=anonymous.base_url, headers=bearer(token), trust_env=False, timeout=LONGEST_S
                )
            )

        yield client
