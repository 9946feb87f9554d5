"""What of users is not in their own row: open sessions, locks, tokens."""

from collections.abc import Collection

from sqlalchemy import func, select

from service.storage.models import ApiTokenRow, FailedLoginRow, UserSessionRow
from service.storage.repository.access.failed_logins import account_key
from service.storage.repository.sessions import Sessions


class UserOverviewRows(Sessions):
    def open_sessions(self, users: Collection[str], *, oldest_ns: int, idle_since_ns: int) -> dict[str, int]:
        """Return how many sessions of each user have not ended; users without one are left out.

        Sessions that began before oldest_ns, or were last used before idle_since_ns, have ended.
        """
        query = (
            select(UserSessionRow.user, func.count())
            .where(
                UserSessionRow.user.in_(users),
                UserSessionRow.created_ns >= oldest_ns,
                UserSessionRow.used_ns >= idle_since_ns,
            )
            .group_by(UserSessionRow.user)
        )
        with self._read() as session:
            return dict(session.execute(query).all())

    def locks_of_users(self, users: Collection[str], *, now_ns: int) -> dict[str, int]:
        """Return until when no login of a user is tried from some address; the others are left out."""
        keys = {account_key(user): user for user in users}
        query = (
            select(FailedLoginRow.account, func.max(FailedLoginRow.locked_until_ns))
            .where(FailedLoginRow.account.in_(keys), FailedLoginRow.locked_until_ns > now_ns)
            .group_by(FailedLoginRow.account)
        )
        with self._read() as session:
            return {keys[account]: until_ns for account, until_ns in session.execute(query)}

    def tokens_of_users(self, users: Collection[str]) -> dict[str, int]:
        """Return how many tokens each user has; users without any are left out."""
        query = (
            select(ApiTokenRow.user, func.count())
            .where(ApiTokenRow.user.in_(users))
            .group_by(ApiTokenRow.user)
        )
        with self._read() as session:
            return dict(session.execute(query).all())
