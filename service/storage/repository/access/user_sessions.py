"""Logins of users, until they end."""

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.errors import NotFoundError
from service.storage.models import UserRow, UserSessionRow
from service.storage.records import Actor, UserSession
from service.storage.repository.access.ending import end_all
from service.storage.repository.access.users import user_of
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found, only


class UserSessionRows(Sessions):
    def begin_session(
        self,
        digest: str,
        user: str,
        way: str,
        *,
        second_factor: bool = False,
        provider_session: str | None = None,
        most: int,
        oldest_ns: int,
        idle_since_ns: int,
        by: Actor,
        now_ns: int,
    ) -> None:
        """Note a login, and its way: "password", or an identity provider's address.

        second_factor: whether more was shown than a password. provider_session: an identity provider, and
        what it calls this login.
        most: sessions of a user; those that were used longest ago end.
        Sessions that began before oldest_ns, or were last used before idle_since_ns, go.

        Raises NotFoundError (the user was deleted, or disabled, meanwhile).
        """
        with self._write() as session:
            _note_login(session, user, way, by=by, now_ns=now_ns)
            over = (UserSessionRow.created_ns < oldest_ns) | (UserSessionRow.used_ns < idle_since_ns)
            session.execute(delete(UserSessionRow).where(over))
            latest = (
                select(UserSessionRow.digest)
                .where(UserSessionRow.user == user)
                .order_by(UserSessionRow.used_ns.desc(), UserSessionRow.digest)
                .offset(most - 1)
            )
            surplus = session.scalars(latest).all()
            session.execute(delete(UserSessionRow).where(UserSessionRow.digest.in_(surplus)))
            session.add(
                UserSessionRow(
                    digest=digest,
                    user=user,
                    origin=by.origin,
                    created_ns=now_ns,
                    used_ns=now_ns,
                    second_factor=second_factor,
                    provider_session=provider_session,
                )
            )

    def note_login(self, user: str, way: str, *, by: Actor, now_ns: int) -> None:
        """Note a login whose session a gateway keeps.

        Raises NotFoundError (the user was deleted, or disabled, meanwhile).
        """
        with self._write() as session:
            _note_login(session, user, way, by=by, now_ns=now_ns)

    def session_of(self, digest: str) -> UserSession | None:
        """Return the login with this secret, over or not; None where there is none."""
        query = select(UserSessionRow, UserRow).join(UserRow, UserRow.name == UserSessionRow.user)
        with self._read() as session:
            row = session.execute(query.where(UserSessionRow.digest == digest)).one_or_none()
            if row is None:
                return None
            login, user = row
            return UserSession(
                user_of(user), login.origin, login.created_ns, login.used_ns, login.second_factor
            )

    def note_session_used(self, digest: str, *, now_ns: int) -> None:
        """Note that a login is used."""
        with self._write() as session:
            session.execute(
                update(UserSessionRow).where(UserSessionRow.digest == digest).values(used_ns=now_ns)
            )

    def end_session(self, digest: str, *, by: Actor, now_ns: int) -> None:
        """End a login; harmless where it has ended."""
        with self._write() as session:
            row = session.get(UserSessionRow, digest, with_for_update=True)
            if row is None:
                return
            note_change(session, by, AuditAction.LOGGED_OUT, ("user", row.user), now_ns=now_ns)
            session.delete(row)

    def end_sessions_of(self, user: str, *, by: Actor, now_ns: int) -> None:
        """End all logins of a user, also those at gateways, and all their tokens. Raises NotFoundError."""
        with self._write() as session:
            row = found(session, UserRow, user, "user", lock=True)
            row.sessions_ended_ns = now_ns
            end_all(session, user, by=by, now_ns=now_ns)
            note_change(session, by, AuditAction.SESSIONS_ENDED, ("user", user), now_ns=now_ns)

    def end_at_provider(
        self, subject: str | None, provider_session: str | None, *, by: Actor, now_ns: int
    ) -> None:
        """End what an identity provider has ended: one login, or all logins and tokens of a user.

        Each is named as it was when it began, with the provider before it; None where the provider does not
        name it. Harmless for what was never here, or has ended.
        """
        with self._write() as session:
            logins = UserSessionRow.provider_session == provider_session
            query = select(UserRow)
            if subject is not None:
                query = query.where(UserRow.subject == subject)
            if provider_session is not None:
                query = query.where(UserRow.name.in_(select(UserSessionRow.user).where(logins)))
            row = only(session, query.order_by(UserRow.name).with_for_update())
            if row is None:
                return
            if provider_session is None:
                row.sessions_ended_ns = now_ns
                end_all(session, row.name, by=by, now_ns=now_ns)
                action = AuditAction.SESSIONS_ENDED
            else:
                session.execute(delete(UserSessionRow).where(UserSessionRow.user == row.name, logins))
                action = AuditAction.LOGGED_OUT
            note_change(session, by, action, ("user", row.name), now_ns=now_ns)


def _note_login(session: Session, user: str, way: str, *, by: Actor, now_ns: int) -> None:
    row = session.get(UserRow, user, with_for_update=True)
    if row is None or row.disabled:
        raise NotFoundError("user", user)
    row.last_login_ns, row.last_login_origin = now_ns, by.origin
    note_change(session, by, AuditAction.LOGGED_IN, ("user", user), now_ns=now_ns, after={"by_way_of": way})
