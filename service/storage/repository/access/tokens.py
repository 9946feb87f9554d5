"""Secrets of users for programs. None lasts longer, or may do more, than the one that asks for it."""

import uuid
from collections.abc import Iterable

from sqlalchemy import delete, func, select, update
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.errors import (
    NotFoundError,
    PasswordOfAnotherError,
    TokenOfAnotherError,
    TooManyTokensError,
    WiderTokenError,
)
from service.storage.models import ApiTokenRow, UserRow
from service.storage.records import Actor, ApiToken, Cursor, Page, User
from service.storage.repository.access.ending import (
    end_tokens,
    scope_words,
    site_names,
    token_document,
    token_of,
    with_descendants,
)
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
        sites: Iterable[str] | None = None,
        expires_ns: int | None,
        parent: str | None = None,
        by: Actor,
        now_ns: int,
    ) -> ApiToken:
        """Keep a new secret of a user by its digest; their tokens that have expired go.

        parent: the token that asks, and with which the new one ends; None where a person does.

        Raises NotFoundError, TooManyTokensError, TokenOfAnotherError, PasswordOfAnotherError,
        WiderTokenError.
        """
        with self._write() as session:
            _require_own(found(session, UserRow, user, "user", lock=True), by)
            session.execute(
                delete(ApiTokenRow).where(ApiTokenRow.user == user, ApiTokenRow.expires_ns <= now_ns)
            )
            number = session.scalar(select(func.count()).where(ApiTokenRow.user == user))
            if number is not None and number >= MOST_TOKENS:
                raise TooManyTokensError(user, MOST_TOKENS)
            row = ApiTokenRow(
                id=str(uuid.uuid4()),
                user=user,
                label=label,
                digest=digest,
                scope=scope_words(scope),
                sites=site_names(sites),
                parent=parent,
                created_ns=now_ns,
                expires_ns=expires_ns,
            )
            added = token_of(row)
            if parent is not None:
                _require_no_wider(added, _token_of_user(session, parent, user))
            session.add(row)
            session.flush()
            note_change(
                session,
                by,
                AuditAction.TOKEN_ADDED,
                ("token", added.id),
                now_ns=now_ns,
                after=token_document(added),
            )
            return added

    def tokens(self, *, user: str | None, limit: int, after: Cursor | None = None) -> Page[ApiToken]:
        """Return the tokens of one user or of all, by id."""
        query = select(ApiTokenRow)
        if user is not None:
            query = query.where(ApiTokenRow.user == user)
        with self._read() as session:
            return page_of(session, query, [ApiTokenRow.id], token_of, limit=limit, after=after)

    def token_with(self, digest: str) -> tuple[ApiToken, User] | None:
        """Return the token with this digest and whose it is, expired or not; None where there is none."""
        query = select(ApiTokenRow, UserRow).join(UserRow, UserRow.name == ApiTokenRow.user)
        with self._read() as session:
            row = session.execute(query.where(ApiTokenRow.digest == digest)).one_or_none()
            return None if row is None else (token_of(row[0]), user_of(row[1]))

    def note_token_used(self, token_id: str, *, now_ns: int) -> None:
        """Note that a token is used."""
        with self._write() as session:
            session.execute(update(ApiTokenRow).where(ApiTokenRow.id == token_id).values(used_ns=now_ns))

    def revoke_token(self, token_id: str, *, user: str | None, by: Actor, now_ns: int) -> None:
        """Delete a token, and those that were made with it; with `user` only one of theirs.

        Raises NotFoundError.
        """
        with self._write() as session:
            row = _token_of_user(session, token_id, user)
            others = session.scalars(select(ApiTokenRow).where(ApiTokenRow.user == row.user)).all()
            for ended in (*with_descendants(others, row),):
                note_change(
                    session,
                    by,
                    AuditAction.TOKEN_REVOKED,
                    ("token", ended.id),
                    now_ns=now_ns,
                    before=token_document(token_of(ended)),
                )
            session.execute(delete(ApiTokenRow).where(ApiTokenRow.id == token_id))  # the others go with it

    def revoke_tokens(self, user: str, *, by: Actor, now_ns: int) -> None:
        """Delete all tokens of a user; harmless where there are none. Raises NotFoundError."""
        with self._write() as session:
            found(session, UserRow, user, "user", lock=True)
            end_tokens(session, user, by=by, now_ns=now_ns)


def _token_of_user(session: Session, token_id: str, user: str | None) -> ApiTokenRow:
    """Return a token, with `user` only one of theirs. Raises NotFoundError."""
    row = only(session, select(ApiTokenRow).where(ApiTokenRow.id == token_id).with_for_update())
    if row is None or user not in (None, row.user):
        raise NotFoundError("token", token_id)
    return row


def _require_own(row: UserRow, by: Actor) -> None:
    """Raise where somebody may not make a token of this user.

    Nobody can log in as a user for a program: the owner of the files stands in for them.
    """
    if row.password_set_by is not None:
        raise PasswordOfAnotherError(row.name, row.password_set_by)
    is_program = row.password is None and row.subject is None
    if by.name != row.name and not (by.owns_files and is_program):
        raise TokenOfAnotherError(row.name)


def _require_no_wider(child: ApiToken, row: ApiTokenRow) -> None:
    """Raise WiderTokenError where a token would outlive the one that asks for it, or allow more."""
    parent = token_of(row)
    if parent.expires_ns is not None and (child.expires_ns is None or child.expires_ns > parent.expires_ns):
        raise WiderTokenError(parent.label, "lasts longer")
    if parent.scope is not None and (child.scope is None or not child.scope <= parent.scope):
        raise WiderTokenError(parent.label, "may do more")
    if parent.sites is not None and (child.sites is None or not child.sites <= parent.sites):
        raise WiderTokenError(parent.label, "is for more sites")
