"""What a route needs of its caller. Every route declares it; a test fails for one that does not."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from re import Pattern
from typing import Any

from fastapi import Depends, Request, params
from starlette.routing import compile_path

from service.access.permissions import Permission
from service.api.access.callers import caller_of
from service.api.access.site_rules import NO_SITE, SiteRule, rule_of


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


@dataclass(frozen=True, slots=True)
class Need:
    """What the route of a request needs: a permission, and what it is about. parameters: of its path."""

    permission: Permission | None = None
    about: SiteRule = NO_SITE
    parameters: Mapping[str, str] = field(default_factory=dict)


class RouteNeeds:
    """What each route needs of its caller, by method and path: known before anything is read of a body.

    Parameters
    ----------
    routes
        Method, path with its parameters in braces, and the permission; None for a route that is open to all.
    """

    def __init__(self, routes: Iterable[tuple[str, str, Permission | None]]) -> None:
        fixed: dict[tuple[str, str], Need] = {}
        patterns: dict[str, list[tuple[Pattern[str], Need]]] = {}
        for method, path, needed in routes:
            need = Need(needed, rule_of(path, needed))
            if "{" in path:
                patterns.setdefault(method, []).append((compile_path(path)[0], need))
            else:
                fixed[method, path] = need
        self._fixed = fixed
        self._patterns: Mapping[str, Sequence[tuple[Pattern[str], Need]]] = patterns
        self.open_paths = frozenset(path for (_, path), need in fixed.items() if need.permission is None)

    def of(self, method: str, path: str) -> Need:
        """Return what the route of a request needs; nothing where there is none, or it is open to all."""
        if (method, path) in self._fixed:
            return self._fixed[method, path]
        for pattern, need in self._patterns.get(method, ()):
            found = pattern.match(path)
            if found is not None:
                return replace(need, parameters=found.groupdict())
        return Need()
