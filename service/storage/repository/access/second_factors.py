"""What users show besides a password: a code of an authenticator app, or one that counts once."""

from collections.abc import Iterable

from sqlalchemy import Select, delete, func, select, update
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.models import RecoveryCodeRow, UserRow, UserSessionRow
from service.storage.records import Actor, Role, TotpSecrets
from service.storage.repository.access.ending import end_all, forget_second_factor
from service.storage.repository.access.users import KIND, require_owner
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found


class SecondFactorRows(Sessions):
    def totp_secrets(self, user: str) -> TotpSecrets:
        """Return what is kept of a user's authenticator app, sealed. Raises NotFoundError."""
        with self._read() as session:
            row = found(session, UserRow, user, KIND)
            return TotpSecrets(row.totp, row.totp_pending)

    def recovery_codes_left(self, user: str) -> int:
        """Return how many codes of a user were not used yet."""
        with self._read() as session:
            return session.scalar(_number_of(user)) or 0

    def propose_totp(self, user: str, sealed: str, *, by: Actor, now_ns: int) -> None:
        """Keep a secret for an authenticator app; it counts once confirmed. Raises NotFoundError."""
        with self._write() as session:
            found(session, UserRow, user, KIND, lock=True).totp_pending = sealed
            note_change(session, by, AuditAction.SECOND_FACTOR_BEGUN, (KIND, user), now_ns=now_ns)

    def confirm_totp(
        self,
        user: str,
        sealed: str,
        step: int,
        *,
        codes: Iterable[str],
        keeps: str,
        by: Actor,
        now_ns: int,
    ) -> bool:
        """Have the secret count that was proposed, with new recovery codes; False where it is another now.

        step: that of the code which confirmed it. codes: digests. keeps: the digest of the session that
        asks; the user's other ones end. Raises NotFoundError.
        """
        with self._write() as session:
            row = found(session, UserRow, user, KIND, lock=True)
            if row.totp_pending != sealed:
                return False
            row.totp, row.totp_pending, row.totp_step = sealed, None, step
            row.second_factor_ns = now_ns
            replace_codes(session, user, codes)
            end_other_sessions(session, user, keeps)
            note_change(
                session,
                by,
                AuditAction.SECOND_FACTOR_ADDED,
                (KIND, user),
                now_ns=now_ns,
                after={"kind": "totp"},
            )
            return True

    def use_totp_step(self, user: str, step: int) -> bool:
        """Use up a step of time; False where a code of it, or of a later one, was used already."""
        with self._write() as session:
            row = found(session, UserRow, user, KIND, lock=True)
            if row.totp_step is not None and step <= row.totp_step:
                return False
            row.totp_step = step
            return True

    def use_recovery_code(self, user: str, digest: str, *, by: Actor, now_ns: int) -> bool:
        """Use up a code of a user; False where there is none."""
        with self._write() as session:
            row = session.get(RecoveryCodeRow, digest, with_for_update=True)
            if row is None or row.user != user:
                return False
            session.delete(row)
            session.flush()
            left = session.scalar(_number_of(user))
            note_change(
                session,
                by,
                AuditAction.RECOVERY_CODE_USED,
                (KIND, user),
                now_ns=now_ns,
                after={"left": left},
            )
            return True

    def replace_recovery_codes(self, user: str, codes: Iterable[str], *, by: Actor, now_ns: int) -> None:
        """Give a user other codes, digests; the old ones count no more. Raises NotFoundError."""
        with self._write() as session:
            found(session, UserRow, user, KIND, lock=True)
            replace_codes(session, user, codes)
            note_change(session, by, AuditAction.RECOVERY_CODES_MADE, (KIND, user), now_ns=now_ns)

    def remove_second_factor(self, user: str, *, by: Actor, now_ns: int) -> None:
        """Forget the second factor of a user. Raises NotFoundError."""
        with self._write() as session:
            forget_second_factor(session, found(session, UserRow, user, KIND, lock=True))
            note_change(session, by, AuditAction.SECOND_FACTOR_REMOVED, (KIND, user), now_ns=now_ns)

    def reset_second_factor(self, user: str, code: str, *, by: Actor, now_ns: int) -> None:
        """Forget the second factor of a user, whose sessions and tokens end.

        code: the digest of one that lets them in once to set up another. Raises NotFoundError,
        AuditorAccountError.
        """
        with self._write() as session:
            row = found(session, UserRow, user, KIND, lock=True)
            if Role.SECAUD in row.roles.split():
                require_owner(by, user, "the second factor")
            forget_second_factor(session, row)
            replace_codes(session, user, (code,))
            end_all(session, user, by=by, now_ns=now_ns)
            note_change(session, by, AuditAction.SECOND_FACTOR_RESET, (KIND, user), now_ns=now_ns)


def replace_codes(session: Session, user: str, codes: Iterable[str]) -> None:
    """Give a user these codes, digests, in place of all others."""
    session.execute(delete(RecoveryCodeRow).where(RecoveryCodeRow.user == user))
    session.add_all(RecoveryCodeRow(digest=digest, user=user) for digest in codes)


def end_other_sessions(session: Session, user: str, keeps: str) -> None:
    """End all sessions of a user but the one of this digest, which has shown the second factor now."""
    session.execute(delete(UserSessionRow).where(UserSessionRow.user == user, UserSessionRow.digest != keeps))
    session.execute(update(UserSessionRow).where(UserSessionRow.digest == keeps).values(second_factor=True))


def _number_of(user: str) -> Select[int]:
    return select(func.count()).where(RecoveryCodeRow.user == user)
