"""Who asks: the caller of a request."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated

from fastapi import Depends, Request

from service.access.identities import Way
from service.access.permissions import Permission, permissions_of, roles_with
from service.access.reach import OF_WHOLE_PLANT, Sites
from service.api.problems import ProblemError
from service.storage.records import Actor, ApiToken
from service.storage.repository import Repository
from service.storage.repository.sites import AtSite

SCOPE_KEY = "statorwatch.caller"

FIRST_USER = (
    "nobody may change anything before there is a user: run `mcc user add NAME --role SECADM --role ENGINEER"
    " --config FILE` on the service's machine, then `mcc login`"
)


@dataclass(frozen=True, slots=True)
class Caller:
    """Who asks, and what they may do: no more than their roles, and less with a token of a narrow scope.

    sites: where their roles hold; None: at all. session: the digest of the session's secret; None for those
    who use none. token: the one that they use.
    password_set_by: who else knows their password, which they are to change before they do anything.
    may_make_tokens: whether they have shown the second factor, where they need one.
    """

    actor: Actor
    permissions: frozenset[Permission]
    way: Way
    sites: Sites = None
    session: str | None = None
    token: ApiToken | None = None
    password_set_by: str | None = None
    may_make_tokens: bool = True

    def demand(self, permission: Permission, what: str = "do this") -> None:
        """Raise ProblemError (403) where the caller may not."""
        if permission not in self.permissions:
            raise forbidden(self, permission, what)

    def demand_here(self, repository: Repository, what: AtSite, *keys: str) -> None:
        """Raise ProblemError (403) where one of these is at another site. For what a path does not name."""
        if self.sites is None:
            return
        if any(repository.is_elsewhere(what, key, self.sites) for key in keys):
            raise elsewhere(self, f"a {what} at another site")


def elsewhere(caller: Caller, what: str) -> ProblemError:
    """Return the answer to a caller whose sites are others. what: it is about."""
    sites = ", ".join(sorted(caller.sites or ())) or "none"
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        f"{caller.actor.name} may not do this: it is about {what}, and the sites of {caller.actor.name} are: "
        f"{sites}; a SECADM gives others (mcc user change {caller.actor.name} --site SITE)",
    )


def forbidden(caller: Caller, permission: Permission, what: str = "do this") -> ProblemError:
    """Return the answer to a caller who may not do something."""
    name = caller.actor.name
    if caller.password_set_by is not None:
        return ProblemError(
            HTTPStatus.FORBIDDEN,
            f"{name} may not {what} yet: {caller.password_set_by} set this password and knows it; change it "
            "first (mcc password, or the page Account)",
        )
    if caller.sites is not None and permission in OF_WHOLE_PLANT & permissions_of(caller.actor.roles):
        return elsewhere(caller, "the whole plant")
    if caller.token is not None and permission in permissions_of(caller.actor.roles):
        scope = ", ".join(sorted(caller.token.scope or ()))
        return ProblemError(
            HTTPStatus.FORBIDDEN,
            f"the token {caller.token.label!r} of {name} may not {what}: it needs the permission "
            f"{permission.value!r}, and the scope of the token is {scope}: use a token with "
            f"{permission.value!r} in its scope (mcc token add LABEL --scope {permission.value}), or log in",
        )
    if caller.session is not None and permission in permissions_of(caller.actor.roles):
        return ProblemError(
            HTTPStatus.FORBIDDEN,
            f"{name} may not {what} yet: a role of theirs needs a second factor; set it up first (mcc "
            "second-factor set-up, or the page Account)",
        )
    roles = ", ".join(roles_with(permission))
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        f"{name} may not {what}: it needs the permission {permission.value!r}, which the roles {roles} have",
    )


def caller_of(request: Request) -> Caller:
    """Return who asks. Raises ProblemError (401) on a route that is open to all, where nobody says so."""
    caller = request.scope.get(SCOPE_KEY)
    if not isinstance(caller, Caller):
        raise ProblemError(HTTPStatus.UNAUTHORIZED, "say who you are")
    return caller


async def _caller_of(request: Request) -> Caller:
    return caller_of(request)


async def _actor_of(request: Request) -> Actor:
    return caller_of(request).actor


By = Annotated[Actor, Depends(_actor_of)]
"""A route that changes something takes `caller: By`, and hands it to the repository as `by`."""

Asking = Annotated[Caller, Depends(_caller_of)]
"""A route whose answer depends on what the caller may do takes `asking: Asking`."""
