"""Users whom a reverse proxy has logged in."""

from collections.abc import Callable, Iterable, Mapping, Sequence

from service.access.identities import Identity, Way
from service.access.permissions import permissions_of
from service.access.reach import Sites, permissions_at
from service.access.user_names import NAME_RULE, name_of
from service.configuration.access import ProxySettings, RoleName
from service.storage import NotFoundError, Repository
from service.storage.records import Role


class ProxiedUserError(Exception):
    """What a proxy says of who asks cannot be used; it says what was expected and found."""


def identity_of_proxied(
    repository: Repository, proxy: ProxySettings, values_of: Callable[[str], Sequence[str]]
) -> Identity | None:
    """Return who a proxy says that asks; None where it says nothing. Raises ProxiedUserError.

    values_of: gives the values of a header.
    """
    if proxy.user_header is None:
        return None
    said = values_of(proxy.user_header)
    if not said:
        return None
    if len(said) > 1:
        raise ProxiedUserError(f"expected one header {proxy.user_header}, found {len(said)}")
    name = name_of(said[0])
    if name is None:
        raise ProxiedUserError(f"expected {NAME_RULE} in {proxy.user_header}, found {said[0][:100]!r}")
    try:
        user = repository.user(name)
    except NotFoundError:
        user = None
    if user is not None and user.disabled:
        raise ProxiedUserError(f"user {name} is disabled")
    if proxy.roles_header is None:
        if user is None:
            raise ProxiedUserError(
                f"there is no user {name}: a SECADM makes one (mcc user add {name} --no-password --role ROLE)"
            )
        roles = user.roles
    sites = None if user is None else user.sites
    if proxy.roles_header is not None:
        groups = [word.strip() for value in values_of(proxy.roles_header) for word in value.split(",")]
        roles = roles_of(groups, proxy.roles)
        if roles >= {Role.SECADM, Role.SECAUD}:
            raise ProxiedUserError(f"expected groups of {name} for SECADM or SECAUD, found both")
        if proxy.sites is not None:
            sites = sites_of(groups, proxy.sites)
    return Identity(name, roles, permissions_at(sites, permissions_of(roles)), Way.PROXY, sites)


def roles_of(groups: Iterable[str], given: Mapping[RoleName, Sequence[str]]) -> frozenset[Role]:
    """Return the roles that groups of somebody else's directory give."""
    found = set(groups)
    return frozenset(Role(role) for role, names in given.items() if found & set(names))


def sites_of(groups: Iterable[str], given: Mapping[str, Sequence[str]] | None) -> Sites:
    """Return the sites that groups of somebody else's directory give; all where it is not asked."""
    if given is None:
        return None
    found = set(groups)
    return frozenset(site for site, names in given.items() if found & set(names))
