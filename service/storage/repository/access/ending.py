"""What ends a user's way in: their sessions, the links that would begin one, tokens and second factor."""

from collections.abc import Iterable, Iterator, Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.models import (
    ApiTokenRow,
    LoginLinkRow,
    PasskeyRow,
    RecoveryCodeRow,
    UserRow,
    UserSessionRow,
)
from service.storage.records import Actor, ApiToken
from service.storage.repository.audit.entries import note_change


def end_sessions(session: Session, name: str) -> None:
    """End all sessions of a user, and the links that would begin another."""
    session.execute(delete(UserSessionRow).where(UserSessionRow.user == name))
    session.execute(delete(LoginLinkRow).where(LoginLinkRow.user == name))


def end_tokens(session: Session, name: str, *, by: Actor, now_ns: int) -> None:
    """End all tokens of a user; the audit trail tells which, if there are any."""
    query = select(ApiTokenRow).where(ApiTokenRow.user == name).order_by(ApiTokenRow.created_ns)
    ended = [token_of(row) for row in session.scalars(query)]
    if ended:
        told = {"ended": [{"id": token.id, **token_document(token)} for token in ended]}
        note_change(session, by, AuditAction.TOKENS_REVOKED, ("user", name), now_ns=now_ns, before=told)
    session.execute(delete(ApiTokenRow).where(ApiTokenRow.user == name))


def end_all(session: Session, name: str, *, by: Actor, now_ns: int) -> None:
    """End all sessions and all tokens of a user."""
    end_sessions(session, name)
    end_tokens(session, name, by=by, now_ns=now_ns)


def forget_second_factor(session: Session, row: UserRow) -> None:
    """Forget the authenticator app of a user, their passkeys and their recovery codes."""
    row.totp = row.totp_pending = row.totp_step = row.second_factor_ns = None
    session.execute(delete(PasskeyRow).where(PasskeyRow.user == row.name))
    session.execute(delete(RecoveryCodeRow).where(RecoveryCodeRow.user == row.name))


def with_descendants(rows: Sequence[ApiTokenRow], first: ApiTokenRow) -> Iterator[ApiTokenRow]:
    """Yield a token and those of `rows` that were made with it, or with one that was."""
    yield first
    for row in rows:
        if row.parent == first.id:
            yield from with_descendants(rows, row)


def token_of(row: ApiTokenRow) -> ApiToken:
    """Return a token without the digest of its secret."""
    return ApiToken(
        id=row.id,
        user=row.user,
        label=row.label,
        scope=None if row.scope is None else frozenset(row.scope.split()),
        sites=None if row.sites is None else frozenset(row.sites),
        parent=row.parent,
        created_ns=row.created_ns,
        expires_ns=row.expires_ns,
        used_ns=row.used_ns,
    )


def token_document(token: ApiToken) -> dict[str, object]:
    """Return what the audit trail keeps of a token."""
    return {
        "user": token.user,
        "label": token.label,
        "scope": None if token.scope is None else sorted(token.scope),
        "sites": None if token.sites is None else sorted(token.sites),
        "parent": token.parent,
        "expires_ns": token.expires_ns,
    }


def site_names(sites: Iterable[str] | None) -> tuple[str, ...] | None:
    """Return sites as their column has them."""
    return None if sites is None else tuple(sorted(set(sites)))


def scope_words(scope: Iterable[str] | None) -> str | None:
    """Return a scope as its column has it."""
    return None if scope is None else " ".join(sorted(set(scope)))
