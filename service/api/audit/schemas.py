"""Documents of the audit trail."""

import json
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from service.api.document import Document
from service.api.times import Time
from service.audit.verification import Fault
from service.storage.records import Role


def _document(text: object) -> object:
    return json.loads(text) if isinstance(text, str) else text


Values = Annotated[dict[str, Any] | None, BeforeValidator(_document)]
"""Values of what was changed, by their names; null where there were none."""


class AuditEntry(Document):
    """Who did what, from where, to what, and the values before and after.

    hash: follows from all else, so also from `previous`, the hash of the entry before. roles: of the actor.
    """

    number: int
    time: Time = Field(validation_alias="time_ns")
    actor: str
    origin: str
    roles: Annotated[list[str], BeforeValidator(lambda text: text.split()), Field(max_length=len(Role))]
    action: str
    subject_kind: str
    subject: str
    before: Values
    after: Values
    previous: str
    hash: str


class AuditHead(Document):
    """The last entry of the trail: whoever keeps it elsewhere can tell later whether the trail was replaced.

    number: 0 where the trail has no entries.
    """

    number: int
    hash: str


class AuditState(AuditHead):
    """The last entry, and `forwarded`, the last one that the syslog server has; null where none is set."""

    forwarded: int | None


class AuditVerification(Document):
    """What came of reading the whole trail.

    entries: those that are right, up to `last`. fault: null, or what was done to the trail: at the entry
    `number`, the first that is wrong, and in words in `message`.
    """

    entries: int
    last: AuditHead
    fault: Fault | None
    number: int | None
    message: str | None
