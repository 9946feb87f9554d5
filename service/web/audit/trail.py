"""The audit trail as the page shows it."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.api.pages import decode, encode
from service.audit.actions import MEANINGS, AuditAction
from service.audit.entries import Anchor, AuditEntry
from service.storage import Repository
from service.web.addresses import address
from service.web.words import phrase, utc

MOST_SHOWN: Final = 50
LONGEST_VALUE: Final = 300


@dataclass(frozen=True, slots=True)
class TrailChoice:
    """Which entries somebody wants to see, as the address of the page says it. from_, to: dates or times."""

    actor: str | None = None
    action: AuditAction | None = None
    subject: str | None = None
    from_: str | None = None
    to: str | None = None
    cursor: str | None = None

    def further(self, cursor: str) -> str:
        """Return the address of the next page."""
        query = {
            "actor": self.actor,
            "action": self.action,
            "subject": self.subject,
            "from": self.from_,
            "to": self.to,
        }
        return address("/audit", **query, cursor=cursor)

    @property
    def is_filtered(self) -> bool:
        """Tell whether some entries are left out."""
        chosen = (self.actor, self.action, self.subject, self.from_, self.to, self.cursor)
        return any(one is not None for one in chosen)


@dataclass(frozen=True, slots=True)
class ChangedValue:
    """A value that was changed, before and after; None where there was none."""

    name: str
    before: str | None
    after: str | None


@dataclass(frozen=True, slots=True)
class TrailLine:
    """An entry in the list."""

    entry: AuditEntry
    action: str
    meaning: str | None
    values: Sequence[ChangedValue]


@dataclass(frozen=True, slots=True)
class Trail:
    """What the page shows. head: the last entry; forwarded: the last one that the syslog server has."""

    choice: TrailChoice
    lines: Sequence[TrailLine]
    next_path: str | None
    head: Anchor
    forwarded: int | None
    actions: Sequence[tuple[AuditAction, str]]


def trail(
    repository: Repository,
    choice: TrailChoice,
    *,
    from_ns: int | None,
    to_ns: int | None,
    is_forwarded: bool,
) -> Trail:
    """Read what the page shows. Raises ProblemError for a cursor that is none."""
    found = repository.audit_entries(
        limit=MOST_SHOWN,
        after=decode(choice.cursor, int),
        actor=choice.actor,
        action=choice.action,
        subject=choice.subject,
        from_ns=from_ns,
        to_ns=to_ns,
    )
    with repository.audit_trail() as whole:
        head = whole.head
    return Trail(
        choice=choice,
        lines=[_line(entry) for entry in found.items],
        next_path=None if found.next is None else choice.further(encode(found.next)),
        head=head,
        forwarded=repository.forwarded_audit_entry() if is_forwarded else None,
        actions=[(action, phrase(action)) for action in AuditAction],
    )


def _line(entry: AuditEntry) -> TrailLine:
    before, after = _values(entry.before), _values(entry.after)
    values = [
        ChangedValue(name, _text(before, name), _text(after, name))
        for name in dict.fromkeys([*before, *after])
    ]
    known = {action.value: meaning for action, meaning in MEANINGS.items()}
    return TrailLine(entry, phrase(entry.action), known.get(entry.action), values)


def _values(document: str | None) -> dict[str, object]:
    found = {} if document is None else json.loads(document)
    return found if isinstance(found, dict) else {"value": found}


def _text(values: dict[str, object], name: str) -> str | None:
    if name not in values or values[name] is None:
        return None
    value = values[name]
    if name.endswith("_ns") and isinstance(value, int):
        return utc(value)
    text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]}…"
