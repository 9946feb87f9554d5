"""What each role may do. docs/reference/roles.md has it with every route; a test compares the two."""

from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Final

from service.storage.records import Role


class Permission(StrEnum):
    """What a route may need. A token's scope names these."""

    VIEW = "view"
    METRICS = "metrics"
    TRIGGER = "trigger"
    ACKNOWLEDGE = "acknowledge"
    NOTE = "note"
    RELEASE = "release"
    RECORDINGS = "recordings"
    CONFIGURE = "configure"
    NOTIFY = "notify"
    ACCOUNT = "account"
    USERS = "users"
    AUDIT = "audit"


MEANINGS: Final[Mapping[Permission, str]] = {
    Permission.VIEW: "See plant, conditions, recordings, alarms and figures.",
    Permission.METRICS: "Read GET /metrics.",
    Permission.TRIGGER: "Have relays make recordings.",
    Permission.ACKNOWLEDGE: "Acknowledge and shelve alarms.",
    Permission.NOTE: "Write into the logbook of a motor, plan stops, tell what inspections found.",
    Permission.RELEASE: "Have a relay visited again that was set aside.",
    Permission.RECORDINGS: "Upload recordings, diagnose them again, delete them.",
    Permission.CONFIGURE: (
        "Choose baselines, restart references, tell what changes a condition, take alarms out of service."
    ),
    Permission.NOTIFY: "See notifications and have a test sent.",
    Permission.ACCOUNT: (
        "See the own account and the description of the API, change the own password, make own tokens."
    ),
    Permission.USERS: "Make, change and delete users, and end their sessions.",
    Permission.AUDIT: "Read the audit trail.",
}
"""What each allows, for the reference page."""

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
