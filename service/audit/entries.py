"""One entry of the audit trail, and the hash that ties it to the entry before it.

    hash = SHA-256(canonical JSON of the entry without its hash, in UTF-8)

Canonical JSON has sorted keys, no spaces, and texts, whole numbers and null alone. So it is that of RFC 8785,
and any tool can compute it. `previous`, the hash of the entry before, is part of the entry.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from core.time_stamps import rfc3339

NO_HASH: Final = "0" * 64
"""`previous` of the first entry."""


@dataclass(frozen=True, slots=True)
class AuditEntry:
    """Who did what, from where, to what.

    number: 1 for the first entry, and one more for each later one. roles: of the actor, with spaces between.
    before, after: what was changed, as canonical JSON; None where there was nothing.
    """

    number: int
    time_ns: int
    actor: str
    origin: str
    roles: str
    action: str
    subject_kind: str
    subject: str
    before: str | None
    after: str | None
    previous: str
    hash: str

    def following(self, number: int, previous: str) -> "AuditEntry":
        """Return the entry behind another one; `sealed` gives it its hash."""
        return replace(self, number=number, previous=previous)

    def at(self, number: int) -> "AuditEntry":
        """Return the entry as it would be in another place of the chain."""
        return replace(self, number=number)


@dataclass(frozen=True, slots=True)
class Anchor:
    """An entry that was seen at a time: its number and its hash. A chain has to have it for ever."""

    number: int
    hash: str


START: Final = Anchor(0, NO_HASH)
"""The head of a trail without entries."""


def sealed(entry: AuditEntry) -> AuditEntry:
    """Return the entry with the hash that follows from all else in it."""
    return replace(entry, hash=digest(entry))


def digest(entry: AuditEntry) -> str:
    """Return the hash that an entry has to have."""
    document = _document(entry)
    return hashlib.sha256(canonical(document).encode()).hexdigest()


def line(entry: AuditEntry) -> str:
    """Return an entry as one line of an export: the canonical JSON that was hashed, and the hash."""
    return canonical({**_document(entry), "hash": entry.hash})


def canonical(document: Mapping[str, object]) -> str:
    """Return JSON with sorted keys and without spaces. Raises ValueError for figures that are no numbers."""
    return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _document(entry: AuditEntry) -> dict[str, object]:
    return {
        "number": entry.number,
        "time": rfc3339(entry.time_ns),
        "actor": entry.actor,
        "origin": entry.origin,
        "roles": entry.roles,
        "action": entry.action,
        "subject_kind": entry.subject_kind,
        "subject": entry.subject,
        "before": entry.before,
        "after": entry.after,
        "previous": entry.previous,
    }
