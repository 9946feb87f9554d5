"""What each role may do."""

from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Final

from service.storage.records import Role


class Permission(StrEnum):
    """What a route may need. A token's scope names these."""

    VIEW = "view"
    """See plant, conditions, recordings, alarms and figures."""
    METRICS = "metrics"
    """Read GET /metrics."""
    TRIGGER = "trigger"
    """Have relays make recordings."""
    ACKNOWLEDGE = "acknowledge"
    """Acknowledge and shelve alarms."""
    NOTE = "note"
    """Write into the logbook of a motor."""
    RELEASE = "release"
    """Have a relay visited again that was set aside."""
    RECORDINGS = "recordings"
    """Upload recordings, diagnose them again, delete them."""
    CONFIGURE = "configure"
    """Choose baselines, restart references, tell what changes a condition, take alarms out of service."""
    NOTIFY = "notify"
    """See notifications and have a test sent."""
    ACCOUNT = "account"
    """See the own account and the description of the API, change the own password, make own tokens."""
    USERS = "users"
    """Make, change and delete users, and end their sessions."""
    AUDIT = "audit"
    """Read the audit trail."""


_VIEWER: Final = frozenset({Permission.VIEW, Permission.METRICS, Permission.ACCOUNT})
_OPERATOR: Final = _VIEWER | {
    Permission.TRIGGER,
    Permission.ACKNOWLEDGE,
    Permission.NOTE,
    Permission.RELEASE,
}
_ENGINEER: Final = _OPERATOR | {Permission.RECORDINGS, Permission.CONFIGURE, Permission.NOTIFY}

PERMISSIONS_OF: Final[Mapping[Role, frozenset[Permission]]] = {
    Role.VIEWER: _VIEWER,
    Role.OPERATOR: _OPERATOR,
    Role.ENGINEER: _ENGINEER,
    Role.SECADM: frozenset({Permission.USERS, Permission.ACCOUNT}),
    Role.SECAUD: frozenset({Permission.AUDIT, Permission.ACCOUNT}),
}
"""An engineer may do all that an operator may, an operator all that a viewer may; the others are apart."""


def permissions_of(roles: Iterable[Role]) -> frozenset[Permission]:
    """Return what somebody with these roles may do."""
    return frozenset().union(*(PERMISSIONS_OF[role] for role in roles))


def roles_with(permission: Permission) -> tuple[Role, ...]:
    """Return the roles that may do this, in their order."""
    return tuple(role for role in Role if permission in PERMISSIONS_OF[role])
