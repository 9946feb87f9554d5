"""Users: made, changed, deleted. What ends with a change ends in the same transaction."""

from collections.abc import Iterable

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.errors import (
    AuditorAccountError,
    LastAdministratorError,
    NotFoundError,
    NotOwnPasswordError,
    RolesNotSeparateError,
    UserExistsError,
)
from service.storage.models import FailedLoginRow, UserRow
from service.storage.records import Actor, Cursor, Page, Role, User
from service.storage.repository.access.ending import (
    end_all,
    end_sessions,
    end_tokens,
    forget_second_factor,
    site_names,
)
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

    def users_with(self, role: Role) -> frozenset[str]:
        """Return the names of the users who have a role, and are not disabled."""
        with self._read() as session:
            rows = session.execute(select(UserRow.name, UserRow.roles).where(UserRow.disabled.is_(False)))
            return frozenset(name for name, words in rows if role in words.split())

    def password_of(self, name: str) -> str | None:
        """Return the hash of a user's password; None for users who are unknown, disabled or have none."""
        with self._read() as session:
            row = session.get(UserRow, name)
            return None if row is None or row.disabled else row.password

    def password_to_change(self, name: str, *, by: Actor) -> str | None:
        """Return the hash of a password that somebody is to change, also of a user who is disabled.

        Raises NotFoundError, AuditorAccountError, NotOwnPasswordError: who may not set a password learns
        nothing of it.
        """
        with self._read() as session:
            row = found(session, UserRow, name, KIND)
            _require_password_here(user_of(row), by)
            return row.password

    def add_user(
        self,
        name: str,
        roles: Iterable[Role],
        *,
        password: str | None,
        sites: Iterable[str] | None = None,
        full_name: str | None = None,
        subject: str | None = None,
        by: Actor,
        now_ns: int,
    ) -> User:
        """Add a user; password is a hash, which they change if somebody else chose it.

        sites: where the roles hold; None: at all of them.

        Raises UserExistsError, RolesNotSeparateError, AuditorAccountError.
        """
        wanted = _separate(name, roles)
        if Role.SECAUD in wanted:
            require_owner(by, name, "the role SECAUD")
        with self._write() as session:
            if session.get(UserRow, name, with_for_update=True) is not None:
                raise UserExistsError(name)
            row = UserRow(
                name=name,
                full_name=full_name,
                roles=_words(wanted),
                sites=site_names(sites),
                subject=subject,
                disabled=False,
                created_ns=now_ns,
            )
            if password is not None:
                _set_password(row, password, by=by, now_ns=now_ns)
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
        sites: Iterable[str] | None = None,
        at_all_sites: bool = False,
        disabled: bool | None = None,
        full_name: str | None = None,
        by: Actor,
        now_ns: int,
    ) -> User:
        """Change what is not None. Other roles or sites end sessions, being disabled tokens, too.

        at_all_sites: have the roles hold everywhere from now on.
        Who becomes an auditor begins without a password, second factor and tokens: others may have them.

        Raises NotFoundError, LastAdministratorError, RolesNotSeparateError, AuditorAccountError.
        """
        wanted = None if roles is None else _separate(name, roles)
        with self._write() as session:
            row = _locked(session, name)
            before = user_of(row)
            if wanted is not None:
                if Role.SECAUD in wanted - before.roles:
                    require_owner(by, name, "the role SECAUD")
                    row.password = row.password_set_ns = row.password_set_by = None
                    forget_second_factor(session, row)
                    end_tokens(session, name, by=by, now_ns=now_ns)
                row.roles = _words(wanted)
            if at_all_sites or sites is not None:
                row.sites = None if at_all_sites else site_names(sites)
            if disabled is not None:
                row.disabled = disabled
            if full_name is not None:
                row.full_name = full_name or None
            session.flush()
            after = user_of(row)
            if _administers(before) and not _administers(after):
                _require_administrator(session, name)
            if (after.roles, after.sites) != (before.roles, before.sites):
                end_sessions(session, name)
            if after.disabled:
                end_all(session, name, by=by, now_ns=now_ns)
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
        """Give a user another password, a hash, which ends their sessions and tokens.

        Where somebody else chose it, they change it before they do anything with it.

        Raises NotFoundError, AuditorAccountError, NotOwnPasswordError.
        """
        with self._write() as session:
            row = _locked(session, name)
            _require_password_here(user_of(row), by)
            _set_password(row, password, by=by, now_ns=now_ns)
            end_all(session, name, by=by, now_ns=now_ns)
            _forget_failures(session, name)
            session.flush()
            after = user_of(row)
            told = {"must_change": after.must_change_password}
            note_change(session, by, AuditAction.PASSWORD_SET, (KIND, name), now_ns=now_ns, after=told)
            return after

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
            end_all(session, name, by=by, now_ns=now_ns)
            forget_second_factor(session, row)
            _forget_failures(session, name)
            session.delete(row)

    def user_of_subject(
        self,
        subject: str,
        name: str,
        roles: Iterable[Role],
        *,
        sites: Iterable[str] | None = None,
        full_name: str | None,
        by: Actor,
        now_ns: int,
    ) -> User:
        """Return who an identity provider says that somebody is, with the roles that it gives them now.

        Whoever was never here becomes a user. sites: where it lets them be; None: where they may be here.

        Raises UserExistsError, where `name` is somebody else, and RolesNotSeparateError.
        """
        wanted = _words(_separate(name, roles))
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
                if row.roles != wanted or before.sites != _known(sites, before.sites):
                    row.roles = wanted
                    end_sessions(session, row.name)
            if sites is not None:
                row.sites = site_names(sites)
            row.full_name, row.confirmed_ns = full_name, now_ns
            session.flush()
            user = user_of(row)
            told = changed({} if before is None else _document(before), _document(user))
            if told[1]:
                note_change(
                    session, by, action, (KIND, user.name), now_ns=now_ns, before=told[0], after=told[1]
                )
            return user

    def refuse_subject(self, subject: str, *, by: Actor, now_ns: int) -> None:
        """Note that the identity provider does not let somebody in any more: they have no role, and all ends.

        Harmless for who was never here.
        """
        with self._write() as session:
            row = only(session, select(UserRow).where(UserRow.subject == subject).with_for_update())
            if row is None:
                return
            before = _document(user_of(row))
            row.roles, row.confirmed_ns = _words(()), None
            end_all(session, row.name, by=by, now_ns=now_ns)
            told = changed(before, _document(user_of(row)))
            if told[1]:
                subject_of = (KIND, row.name)
                note_change(
                    session,
                    by,
                    AuditAction.USER_CHANGED,
                    subject_of,
                    now_ns=now_ns,
                    before=told[0],
                    after=told[1],
                )


def user_of(row: UserRow) -> User:
    """Return a user without the hash of the password."""
    return User(
        name=row.name,
        full_name=row.full_name,
        roles=frozenset(map(Role, row.roles.split())),
        sites=None if row.sites is None else frozenset(row.sites),
        disabled=row.disabled,
        has_password=row.password is not None,
        subject=row.subject,
        created_ns=row.created_ns,
        password_set_ns=row.password_set_ns,
        password_set_by=row.password_set_by,
        sessions_ended_ns=row.sessions_ended_ns,
        confirmed_ns=row.confirmed_ns,
        last_login_ns=row.last_login_ns,
        last_login_origin=row.last_login_origin,
        second_factor_ns=row.second_factor_ns,
    )


def _document(user: User) -> dict[str, object]:
    """Return what the audit trail keeps of a user."""
    return {
        "full_name": user.full_name,
        "roles": sorted(user.roles),
        "sites": None if user.sites is None else sorted(user.sites),
        "disabled": user.disabled,
        "subject": user.subject,
    }


def _separate(name: str, roles: Iterable[Role]) -> frozenset[Role]:
    """Return roles that one user may have. Raises RolesNotSeparateError."""
    wanted = frozenset(roles)
    if wanted >= {Role.SECADM, Role.SECAUD}:
        raise RolesNotSeparateError(name)
    return wanted


def require_owner(by: Actor, name: str, what: str) -> None:
    """Raise AuditorAccountError for all but the owner of the files: no SECADM gets to be an auditor."""
    if not by.owns_files:
        raise AuditorAccountError(name, what)


def _require_password_here(user: User, by: Actor) -> None:
    """Raise where somebody may not set a user's password: AuditorAccountError, NotOwnPasswordError."""
    if user.subject is not None:
        raise NotOwnPasswordError(user.name, "they log in at the identity provider")
    if Role.SECAUD in user.roles and by.name != user.name:
        require_owner(by, user.name, "the password")


def _set_password(row: UserRow, password: str, *, by: Actor, now_ns: int) -> None:
    """Keep a password's hash, and who else knows it; the owner of the files could read all anyway."""
    row.password, row.password_set_ns = password, now_ns
    row.password_set_by = None if by.owns_files or by.name == row.name else by.name


def _known(sites: Iterable[str] | None, before: frozenset[str] | None) -> frozenset[str] | None:
    """Return the sites from now on, where an identity provider may tell them."""
    return before if sites is None else frozenset(sites)


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
