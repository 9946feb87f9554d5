"""Users: made, changed, deleted. What ends with a change ends in the same transaction."""

from collections.abc import Iterable

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.errors import LastAdministratorError, NotFoundError, UserExistsError
from service.storage.models import ApiTokenRow, FailedLoginRow, LoginLinkRow, UserRow, UserSessionRow
from service.storage.records import Actor, Cursor, Page, Role, User
from service.storage.repository.access.failed_logins import account_key
from service.storage.repository.audit.entries import note_change
from service.storage.repository.audit.values import changed
from service.storage.repository.sessions import Sessions, found, only, page_of

KIND = "user"


class UserRows(Sessions):
    def has_users(self) -> bool:
        """Tell whether there is any user."""
        with self._read() as session:
            return bool(session.scalar(select(exists().where(UserRow.name.is_not(None)))))

    def user(self, name: str) -> User:
        """Return a user. Raises NotFoundError."""
        with self._read() as session:
            return user_of(found(session, UserRow, name, KIND))

    def users(self, *, limit: int, after: Cursor | None = None) -> Page[User]:
        """Return users, by name."""
        with self._read() as session:
            return page_of(session, select(UserRow), [UserRow.name], user_of, limit=limit, after=after)

    def password_of(self, name: str) -> str | None:
        """Return the hash of a user's password; None for users who are unknown, disabled or have none."""
        with self._read() as session:
            row = session.get(UserRow, name)
            return None if row is None or row.disabled else row.password

    def add_user(
        self,
        name: str,
        roles: Iterable[Role],
        *,
        password: str | None,
        full_name: str | None = None,
        subject: str | None = None,
        by: Actor,
        now_ns: int,
    ) -> User:
        """Add a user; password is a hash. Raises UserExistsError."""
        with self._write() as session:
            if session.get(UserRow, name, with_for_update=True) is not None:
                raise UserExistsError(name)
            row = UserRow(
                name=name,
                full_name=full_name,
                roles=_words(roles),
                password=password,
                subject=subject,
                disabled=False,
                created_ns=now_ns,
                password_set_ns=None if password is None else now_ns,
            )
            session.add(row)
            session.flush()
            user = user_of(row)
            note_change(
                session, by, AuditAction.USER_ADDED, (KIND, name), now_ns=now_ns, after=_document(user)
            )
            return user

    def change_user(
        self,
        name: str,
        *,
        roles: Iterable[Role] | None = None,
        disabled: bool | None = None,
        full_name: str | None = None,
        by: Actor,
        now_ns: int,
    ) -> User:
        """Change what is not None. Other roles, and being disabled, end the user's sessions.

        Raises NotFoundError, LastAdministratorError.
        """
        with self._write() as session:
            row = _locked(session, name)
            before = user_of(row)
            if roles is not None:
                row.roles = _words(roles)
            if disabled is not None:
                row.disabled = disabled
            if full_name is not None:
                row.full_name = full_name or None
            session.flush()
            after = user_of(row)
            if _administers(before) and not _administers(after):
                _require_administrator(session, name)
            if after.roles != before.roles or after.disabled:
                end_sessions(session, name)
            if after != before:
                told = changed(_document(before), _document(after))
                note_change(
                    session,
                    by,
                    AuditAction.USER_CHANGED,
                    (KIND, name),
                    now_ns=now_ns,
                    before=told[0],
                    after=told[1],
                )
            return after

    def set_password(self, name: str, password: str, *, by: Actor, now_ns: int) -> User:
        """Give a user another password, a hash, which ends their sessions. Raises NotFoundError."""
        with self._write() as session:
            row = _locked(session, name)
            row.password, row.password_set_ns = password, now_ns
            end_sessions(session, name)
            _forget_failures(session, name)
            session.flush()
            note_change(session, by, AuditAction.PASSWORD_SET, (KIND, name), now_ns=now_ns)
            return user_of(row)

    def renew_hash(self, name: str, before: str, after: str) -> None:
        """Keep a password under a hash of other costs, if it is still the same password."""
        with self._write() as session:
            row = session.get(UserRow, name, with_for_update=True)
            if row is not None and row.password == before:
                row.password = after

    def unlock_user(self, name: str, *, by: Actor, now_ns: int) -> User:
        """Forget the failed logins of a user. Raises NotFoundError."""
        with self._write() as session:
            row = _locked(session, name)
            _forget_failures(session, name)
            note_change(session, by, AuditAction.USER_UNLOCKED, (KIND, name), now_ns=now_ns)
            return user_of(row)

    def delete_user(self, name: str, *, by: Actor, now_ns: int) -> None:
        """Delete a user with their sessions and tokens. Raises NotFoundError, LastAdministratorError."""
        with self._write() as session:
            row = _locked(session, name)
            user = user_of(row)
            if _administers(user):
                _require_administrator(session, name)
            note_change(
                session, by, AuditAction.USER_DELETED, (KIND, name), now_ns=now_ns, before=_document(user)
            )
            end_sessions(session, name)
            session.execute(delete(ApiTokenRow).where(ApiTokenRow.user == name))
            _forget_failures(session, name)
            session.delete(row)

    def user_of_subject(
        self, subject: str, name: str, roles: Iterable[Role], *, full_name: str | None, by: Actor, now_ns: int
    ) -> User:
        """Return who an identity provider says that somebody is, with the roles that it gives them now.

        Whoever was never here becomes a user. Raises UserExistsError, where `name` is somebody else.
        """
        wanted = _words(roles)
        with self._write() as session:
            row = only(session, select(UserRow).where(UserRow.subject == subject).with_for_update())
            if row is None:
                if session.get(UserRow, name, with_for_update=True) is not None:
                    raise UserExistsError(name)
                row = UserRow(
                    name=name, subject=subject, roles=wanted, password=None, disabled=False, created_ns=now_ns
                )
                session.add(row)
                session.flush()
                action, before = AuditAction.USER_ADDED, None
            else:
                action, before = AuditAction.USER_CHANGED, user_of(row)
                if row.roles != wanted:
                    row.roles = wanted
                    end_sessions(session, row.name)
            row.full_name = full_name
            session.flush()
            user = user_of(row)
            if user != before:
                told = changed({} if before is None else _document(before), _document(user))
                note_change(
                    session, by, action, (KIND, user.name), now_ns=now_ns, before=told[0], after=told[1]
                )
            return user


def user_of(row: UserRow) -> User:
    """Return a user without the hash of the password."""
    return User(
        name=row.name,
        full_name=row.full_name,
        roles=frozenset(map(Role, row.roles.split())),
        disabled=row.disabled,
        has_password=row.password is not None,
        subject=row.subject,
        created_ns=row.created_ns,
        password_set_ns=row.password_set_ns,
        sessions_ended_ns=row.sessions_ended_ns,
        last_login_ns=row.last_login_ns,
        last_login_origin=row.last_login_origin,
    )


def _document(user: User) -> dict[str, object]:
    """Return what the audit trail keeps of a user."""
    return {
        "full_name": user.full_name,
        "roles": sorted(user.roles),
        "disabled": user.disabled,
        "subject": user.subject,
    }


def end_sessions(session: Session, name: str) -> None:
    """End all sessions of a user, and the links that would begin another."""
    session.execute(delete(UserSessionRow).where(UserSessionRow.user == name))
    session.execute(delete(LoginLinkRow).where(LoginLinkRow.user == name))


def _words(roles: Iterable[Role]) -> str:
    return " ".join(sorted(set(roles)))


def _locked(session: Session, name: str) -> UserRow:
    row = session.get(UserRow, name, with_for_update=True)
    if row is None:
        raise NotFoundError(KIND, name)
    return row


def _administers(user: User) -> bool:
    return Role.SECADM in user.roles and not user.disabled


def _require_administrator(session: Session, name: str) -> None:
    """Raise LastAdministratorError where nobody but this user manages users.

    Two who would take each other's role at once wait for each other.
    """
    others = (
        select(UserRow)
        .where(UserRow.name != name, UserRow.disabled.is_(False))
        .order_by(UserRow.name)
        .with_for_update()
    )
    if not any(_administers(user_of(row)) for row in session.scalars(others)):
        raise LastAdministratorError(name)


def _forget_failures(session: Session, name: str) -> None:
    session.execute(delete(FailedLoginRow).where(FailedLoginRow.account == account_key(name)))
