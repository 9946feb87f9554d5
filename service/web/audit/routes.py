"""The page of the audit trail, and its verification."""

from typing import Annotated, Final

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.audit.trail import verify_audit_trail
from service.api.problems import ProblemError, WrongFieldError
from service.api.times import MAX_NS, nanoseconds
from service.audit.actions import AuditAction
from service.web.audit.trail import TrailChoice, trail
from service.web.view import Looking

router = APIRouter()

AUDIT: Final = [require(Permission.AUDIT)]

Text = Annotated[str | None, Query(max_length=200, pattern=r"^[^\x00]*$")]
TimeText = Annotated[str | None, Query(max_length=40)]


@router.get("/audit", dependencies=AUDIT)
def show_audit_trail(
    view: Looking,
    actor: Text = None,
    action: Annotated[str | None, Query(max_length=50)] = None,
    subject: Text = None,
    from_: Annotated[TimeText, Query(alias="from")] = None,
    to: TimeText = None,
    cursor: Annotated[str | None, Query(max_length=1000)] = None,
) -> Response:
    """Show who changed what, latest first."""
    choice = TrailChoice(
        actor=(actor or "").strip() or None,
        action=_action(action),
        subject=(subject or "").strip() or None,
        from_=from_ or None,
        to=to or None,
        cursor=cursor or None,
    )
    found = trail(
        view.context.repository,
        choice,
        from_ns=_time("from", choice.from_),
        to_ns=_time("to", choice.to),
        is_forwarded=view.context.settings.audit.syslog is not None,
    )
    return view.page("audit/trail.html", title="Audit trail", found=found)


@router.get("/audit/verification", dependencies=AUDIT)
async def show_verification(
    view: Looking,
    number: Annotated[str, Query(max_length=20)] = "",
    hash_: Annotated[str, Query(alias="hash", max_length=100)] = "",
) -> Response:
    """Read the whole trail, and show whether every entry is as it was written."""
    kept = _number(number)
    found = await verify_audit_trail(view.context, kept, hash_.strip().lower() or None)
    return view.page("audit/verification.html", title="Verification", found=found, anchor=kept)


def _action(text: str | None) -> AuditAction | None:
    try:
        return AuditAction(text) if text else None
    except ValueError as error:
        raise _wrong("action", "one of the actions in the list") from error


def _time(field: str, text: str | None) -> int | None:
    try:
        return None if text is None else nanoseconds(text)
    except ValueError as error:
        raise _wrong(field, "a date such as 2026-01-31") from error


def _number(text: str) -> int | None:
    if not text.strip():
        return None
    if not text.strip().isascii() or not text.strip().isdigit() or not 1 <= int(text) <= MAX_NS:
        raise _wrong("number", "the number of an entry")
    return int(text)


def _wrong(field: str, expected: str) -> ProblemError:
    return WrongFieldError(f"query.{field}", f"expected {expected}")
