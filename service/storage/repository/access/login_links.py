"""Links that begin one session of a user each."""

from sqlalchemy import delete

from service.audit.actions import AuditAction
from service.storage.errors import NotFoundError
from service.storage.models import LoginLinkRow, UserRow
from service.storage.records import Actor, User
from service.storage.repository.access.users import user_of
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions


class LoginLinkRows(Sessions):
    def add_login_link(self, digest: str, user: str, *, expires_ns: int, by: Actor, now_ns: int) -> None:
        """Keep a new link of a user by the digest of its secret; links that have expired go.

        Raises NotFoundError (there is no such user, or they are disabled).
        """
        with self._write() as session:
            row = session.get(UserRow, user, with_for_update=True)
            if row is None or row.disabled:
                raise NotFoundError("user", user)
            session.execute(delete(LoginLinkRow).where(LoginLinkRow.expires_ns <= now_ns))
            session.add(LoginLinkRow(digest=digest, user=user, expires_ns=expires_ns))
            note_change(
                session,
                by,
                AuditAction.LOGIN_LINK_MADE,
                ("user", user),
                now_ns=now_ns,
                after={"expires_ns": expires_ns},
            )

    def has_login_link(self, digest: str, *, now_ns: int) -> bool:
        """Tell whether a link can still be followed."""
        with self._read() as session:
            row = session.get(LoginLinkRow, digest)
            return row is not None and row.expires_ns > now_ns

    def take_login_link(self, digest: str, *, now_ns: int) -> User | None:
        """Return whose link it is, and let it be followed no more; None where it cannot be followed."""
        with self._write() as session:
            row = session.get(LoginLinkRow, digest, with_for_update=True)
            if row is None:
                return None
            session.delete(row)
            user = session.get(UserRow, row.user)
            if user is None or user.disabled or row.expires_ns <= now_ns:
                return None
            return user_of(user)
