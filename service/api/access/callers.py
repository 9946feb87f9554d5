"""Who asks: the caller of a request."""

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request

from service.access.permissions import Permission, permissions_of
from service.storage.records import Actor, Role


@dataclass(frozen=True, slots=True)
class Caller:
    """Who asks, and what they may do: no more than their roles, and less with a token of a narrow scope."""

    actor: Actor
    permissions: frozenset[Permission]


def caller_of(request: Request) -> Caller:
    """Return who asks. Nobody has to say so yet: everybody has all roles."""
    roles = frozenset(Role)
    address = request.client.host if request.client else ""
    return Caller(Actor("anonymous", address, roles), permissions_of(roles))


async def _actor_of(request: Request) -> Actor:
    return caller_of(request).actor


By = Annotated[Actor, Depends(_actor_of)]
"""A route that changes something takes `by: By`, and hands it to the repository."""
