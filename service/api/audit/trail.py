"""Routes of the audit trail."""

from collections.abc import AsyncIterator, Iterator
from typing import Annotated

from fastapi import APIRouter, Depends, Query
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import StreamingResponse
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.audit.schemas import AuditEntry, AuditState, AuditVerification
from service.api.context import ApiContext, Context
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import WrongFieldError, problems
from service.api.times import MAX_NS, From, To
from service.audit.actions import AuditAction
from service.audit.entries import Anchor, line
from service.audit.verification import Verification, verify

router = APIRouter(prefix="/audit", tags=["audit"], dependencies=[require(Permission.AUDIT)])

LINES = "application/jsonl"

Text = Annotated[str | None, Query(min_length=1, max_length=200, pattern=r"^[^\x00]+$")]
Number = Annotated[int, Query(ge=1, le=MAX_NS)]


class Lines(StreamingResponse):
    """Entries, one a line, as long as there are some."""

    media_type = LINES


@router.get("/entries", responses=problems())
def list_audit_entries(
    context: Context,
    actor: Text = None,
    action: AuditAction | None = None,
    subject: Annotated[Text, Query(description="Name or id of what was changed.")] = None,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[AuditEntry]:
    """Return who changed what, latest first."""
    entries = context.repository.audit_entries(
        limit=limit,
        after=decode(cursor, int),
        actor=actor,
        action=action,
        subject=subject,
        from_ns=from_,
        to_ns=to,
    )
    return page(entries, AuditEntry.model_validate)


@router.get("/head", responses=problems())
def get_audit_head(context: Context) -> AuditState:
    """Return number and hash of the last entry. Keep them elsewhere to verify the trail against."""
    with context.repository.audit_trail() as trail:
        head = trail.head
    is_forwarded = context.settings.audit.syslog is not None
    forwarded = context.repository.forwarded_audit_entry() if is_forwarded else None
    return AuditState(number=head.number, hash=head.hash, forwarded=forwarded)


async def _turn(context: Context) -> AsyncIterator[None]:
    """Hold one of the places for whole trails until the answer has been sent."""
    async with context.audit_trails.admitted():
        yield


@router.get(
    "/export",
    response_class=Lines,
    responses=problems() | {200: {"content": {LINES: {"schema": {"type": "string"}}}}},
    dependencies=[Depends(_turn)],
)
def export_audit_trail(
    context: Context,
    first: Annotated[Number, Query(description="Number of the first entry.")] = 1,
    last: Annotated[Number | None, Query(description="Number of the last; without: the latest.")] = None,
) -> Response:
    """Return all entries, oldest first, one a line of canonical JSON: what was hashed, and the hash.

    What is added while the answer is sent is not in it.
    """
    with context.repository.audit_trail() as trail:
        end = trail.head.number if last is None else min(last, trail.head.number)
    return Lines(_lines(context, first, end))


@router.get("/verification", responses=problems())
async def verify_audit_trail(
    context: Context,
    number: Annotated[Number | None, Query(description="An entry that was kept elsewhere.")] = None,
    hash_: Annotated[
        str | None, Query(alias="hash", max_length=64, pattern=r"^[0-9a-f]{64}$", description="And its hash.")
    ] = None,
) -> AuditVerification:
    """Read the whole trail, and return whether every entry is as it was written.

    A trail that was computed anew, or whose end was cut off together with its head, is found only with an
    entry that was kept elsewhere: its number and its hash.
    """
    if (number is None) != (hash_ is None):
        message = "expected number and hash of one entry, found one of the two"
        missing = "query.number" if number is None else "query.hash"
        raise WrongFieldError(missing, message)
    anchors = [] if number is None or hash_ is None else [Anchor(number, hash_)]
    async with context.audit_verifications.admitted():
        verification = await run_in_threadpool(_verified, context, anchors)
    return AuditVerification.model_validate(verification)


def _lines(context: ApiContext, first: int, last: int) -> Iterator[str]:
    """Yield the lines of some entries at a time: no transaction lasts while a client takes them."""
    while first <= last:
        entries = context.repository.audit_entries_from(first, last)
        if not entries:
            return
        yield "".join(f"{line(entry)}\n" for entry in entries)
        first = entries[-1].number + 1


def _verified(context: ApiContext, anchors: list[Anchor]) -> Verification:
    with context.repository.audit_trail() as trail:
        return verify(trail.entries, head=trail.head, anchors=anchors)
