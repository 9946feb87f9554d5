"""Where the roles of somebody hold: at some sites of the plant, or at all of them.

Sites are a set of names; None stands for all sites, those to come included.
"""

from collections.abc import Collection
from typing import Final

from service.access.permissions import Permission

Sites = frozenset[str] | None

OF_WHOLE_PLANT: Final = frozenset({Permission.METRICS, Permission.NOTIFY})
"""Figures and messages of all sites together: who is limited to some does not have these permissions."""

OF_PEOPLE: Final = frozenset({Permission.ACCOUNT, Permission.USERS, Permission.AUDIT})
"""These are about people, whose accounts are at no site: sites do not limit them."""


def both(one: Sites, other: Sites) -> Sites:
    """Return the sites that are in both."""
    if one is None or other is None:
        return other if one is None else one
    return one & other


def is_within(one: Collection[str] | None, other: Sites) -> bool:
    """Tell whether all of the first are among the second."""
    return other is None or (one is not None and other.issuperset(one))


def permissions_at(sites: Sites, permissions: Collection[Permission]) -> frozenset[Permission]:
    """Return what is left of permissions for somebody who is limited to sites."""
    return frozenset(permissions) if sites is None else frozenset(permissions) - OF_WHOLE_PLANT
