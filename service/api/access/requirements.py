"""What a route needs of its caller. Every route declares it; a test fails for one that does not."""

from collections.abc import Sequence
from typing import Any

from fastapi import Depends, Request, params

from service.access.permissions import Permission
from service.api.access.callers import caller_of


class Requirement:
    """A dependency that refuses callers without a permission."""

    def __init__(self, permission: Permission) -> None:
        self.permission = permission

    async def __call__(self, request: Request) -> None:
        """Raise ProblemError (403) where the caller may not."""
        caller_of(request).demand(self.permission)


def require(permission: Permission) -> Any:
    """Return the dependency of a route: `dependencies=[require(Permission.VIEW)]`."""
    return Depends(Requirement(permission))


async def _nothing() -> None:
    """Ask for nothing."""


def open_to_all() -> Any:
    """Return the dependency of a route that answers anybody, also those who do not say who they are."""
    return Depends(_nothing)


def requirement_of(dependencies: Sequence[params.Depends]) -> Permission | None:
    """Return the permission that a route needs; None for one that is open to all.

    Raises LookupError where it declares neither.
    """
    for dependency in dependencies:
        if isinstance(dependency.dependency, Requirement):
            return dependency.dependency.permission
        if dependency.dependency is _nothing:
            return None
    raise LookupError("expected a route with require(Permission....) or open_to_all() in its dependencies")
