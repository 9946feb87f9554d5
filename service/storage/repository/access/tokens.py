"""Secrets of users for programs."""

import uuid
from collections.abc import Iterable

from sqlalchemy import func, select, update

from service.audit.actions import AuditAction
from service.storage.errors import NotFoundError, TooManyTokensError
from service.storage.models import ApiTokenRow, UserRow
from service.storage.records import Actor, ApiToken, Cursor, Page, User
from service.storage.repository.access.users import user_of
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found, only, page_of

MOST_TOKENS = 100
"""A user has at most so many."""


class TokenRows(Sessions):
    def add_token(
        self,
        user: str,
        label: str,
        digest: str,
        *,
        scope: Iterable[str] | None,
        expires_ns: int | None,
        by: Actor,
        now_ns: int,
    ) -> ApiToken:
        """Keep a new secret of a user by its digest. Raises NotFoundError, TooManyTokensError."""
        with self._write() as session:
            found(session, UserRow, user, "user", lock=True)
            number = session.scalar(select(func.count()).where(ApiTokenRow.user == user))
            if number is not None and number >= MOST_TOKENS:
                raise TooManyTokensError(user, MOST_TOKENS)
            row = ApiTokenRow(
                id=str(uuid.uuid4()),
                user=user,
                label=label,
                digest=digest,
                scope=None if scope is None else " ".join(sorted(set(scope))),
                created_ns=now_ns,
                expires_ns=expires_ns,
            )
            session.add(row)
            session.flush()
            added = _token(row)
            note_change(
                session,
                by,
                AuditAction.TOKEN_ADDED,
                ("token", added.id),
                now_ns=now_ns,
                after=_document(added),
            )
            return added

    def tokens(self, *, user: str | None, limit: int, after: Cursor | None = None) -> Page[ApiToken]:
        """Return the tokens of one user or of all, by id."""
        query = select(ApiTokenRow)
        if user is not None:
            query = query.where(ApiTokenRow.user == user)
        with self._read() as session:
            return page_of(session, query, [ApiTokenRow.id], _token, limit=limit, after=after)

    def token_with(self, digest: str) -> tuple[ApiToken, User] | None:
        """Return the token with this digest and whose it is, expired or not; None where there is none."""
        query = select(ApiTokenRow, UserRow).join(UserRow, UserRow.name == ApiTokenRow.user)
        with self._read() as session:
            row = session.execute(query.where(ApiTokenRow.digest == digest)).one_or_none()
            return None if row is None else (_token(row[0]), user_of(row[1]))

    def note_token_used(self, token_id: str, *, now_ns: int) -> None:
        """Note that a token is used."""
        with self._write() as session:
            session.execute(update(ApiTokenRow).where(ApiTokenRow.id == token_id).values(used_ns=now_ns))

    def revoke_token(self, token_id: str, *, user: str | None, by: Actor, now_ns: int) -> None:
        """Delete a token; with `user` only one of theirs. Raises NotFoundError."""
        query = select(ApiTokenRow).where(ApiTokenRow.id == token_id).with_for_update()
        with self._write() as session:
            row = only(session, query)
            if row is None or user not in (None, row.user):
                raise NotFoundError("token", token_id)
            note_change(
                session,
                by,
                AuditAction.TOKEN_REVOKED,
                ("token", token_id),
                now_ns=now_ns,
                before=_document(_token(row)),
            )
            session.delete(row)


def _token(row: ApiTokenRow) -> ApiToken:
    return ApiToken(
        id=row.id,
        user=row.user,
        label=row.label,
        scope=None if row.scope is None else frozenset(row.scope.split()),
        created_ns=row.created_ns,
        expires_ns=row.expires_ns,
        used_ns=row.used_ns,
    )


def _document(token: ApiToken) -> dict[str, object]:
    """Return what the audit trail keeps of a token."""
    return {
        "user": token.user,
        "label": token.label,
        "scope": None if token.scope is None else sorted(token.scope),
        "expires_ns": token.expires_ns,
    }
