"""Passkeys of users: a second factor beside, or in place of, an authenticator app."""

import uuid
from collections.abc import Iterable, Sequence

from sqlalchemy import delete, insert, select
from sqlalchemy.exc import IntegrityError

from service.audit.actions import AuditAction
from service.storage.errors import LastFactorError, NotFoundError, PasskeyExistsError
from service.storage.models import PasskeyRow, UsedOnceRow, UserRow
from service.storage.records import Actor, NewPasskey, Passkey
from service.storage.repository.access.ending import forget_second_factor
from service.storage.repository.access.second_factors import end_other_sessions, replace_codes
from service.storage.repository.access.users import KIND
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found, only


class PasskeyRows(Sessions):
    def passkeys(self, user: str) -> Sequence[Passkey]:
        """Return the passkeys of a user, the oldest first."""
        query = (
            select(PasskeyRow).where(PasskeyRow.user == user).order_by(PasskeyRow.created_ns, PasskeyRow.id)
        )
        with self._read() as session:
            return [_passkey(row) for row in session.scalars(query)]

    def passkey_of(self, user: str, credential: str) -> Passkey | None:
        """Return the passkey of a user with this credential; None where it is nobody's, or another's."""
        query = select(PasskeyRow).where(PasskeyRow.user == user, PasskeyRow.credential == credential)
        with self._read() as session:
            row = only(session, query)
            return None if row is None else _passkey(row)

    def add_passkey(
        self,
        user: str,
        label: str,
        new: NewPasskey,
        *,
        most: int,
        codes: Iterable[str],
        keeps: str,
        by: Actor,
        now_ns: int,
    ) -> tuple[Passkey, bool]:
        """Keep a passkey; return it, and whether the recovery codes count that came with it.

        most: that a user has. codes: digests, for who had no second factor; others go on with their own.
        keeps: the digest of the session that asks; the user's other ones end.
        Raises NotFoundError, PasskeyExistsError.
        """
        with self._write() as session:
            owner = found(session, UserRow, user, KIND, lock=True)
            present = session.scalars(select(PasskeyRow.label).where(PasskeyRow.user == user)).all()
            taken = only(session, select(PasskeyRow).where(PasskeyRow.credential == new.credential))
            if taken is not None or label in present or len(present) >= most:
                raise PasskeyExistsError(label, most)
            row = PasskeyRow(
                id=str(uuid.uuid4()),
                user=user,
                label=label,
                credential=new.credential,
                public_key=new.public_key,
                signatures=new.signatures,
                created_ns=now_ns,
            )
            session.add(row)
            is_first = owner.second_factor_ns is None
            if is_first:
                owner.second_factor_ns = now_ns
                replace_codes(session, user, codes)
            end_other_sessions(session, user, keeps)
            note_change(
                session,
                by,
                AuditAction.SECOND_FACTOR_ADDED,
                (KIND, user),
                now_ns=now_ns,
                after=_document(row),
            )
            return _passkey(row), is_first

    def use_passkey(self, passkey: str, signatures: int, *, now_ns: int) -> bool:
        """Note that a passkey lets its user in; False where it is gone, or has counted as far before.

        signatures: what the device has counted; a device that never counts has 0.
        """
        with self._write() as session:
            row = session.get(PasskeyRow, passkey, with_for_update=True)
            if row is None or (max(signatures, row.signatures) > 0 and signatures <= row.signatures):
                return False
            row.signatures, row.used_ns = signatures, now_ns
            return True

    def remove_passkey(
        self, user: str, passkey: str, *, needs_factor: bool, keeps: str, by: Actor, now_ns: int
    ) -> None:
        """Forget a passkey of a user; with the last factor their recovery codes go.

        needs_factor: whether a role needs one. keeps: the digest of the session that asks; the others end.
        Raises NotFoundError, LastFactorError.
        """
        with self._write() as session:
            owner = found(session, UserRow, user, KIND, lock=True)
            row = session.get(PasskeyRow, passkey)
            if row is None or row.user != user:
                raise NotFoundError("passkey", passkey)
            others = select(PasskeyRow).where(PasskeyRow.user == user, PasskeyRow.id != passkey)
            is_last = owner.totp is None and only(session, others) is None
            if is_last and needs_factor:
                raise LastFactorError(row.label)
            before = _document(row)
            session.delete(row)
            session.flush()
            if is_last:
                forget_second_factor(session, owner)
            end_other_sessions(session, user, keeps)
            note_change(
                session, by, AuditAction.SECOND_FACTOR_REMOVED, (KIND, user), now_ns=now_ns, before=before
            )

    def use_once(self, digest: str, *, expires_ns: int, now_ns: int) -> bool:
        """Use up what counts once, of this digest; False where it was used before."""
        try:
            with self._write() as session:
                session.execute(delete(UsedOnceRow).where(UsedOnceRow.expires_ns <= now_ns))
                session.execute(insert(UsedOnceRow).values(digest=digest, expires_ns=expires_ns))
        except IntegrityError:
            return False
        return True


def _document(row: PasskeyRow) -> dict[str, object]:
    """Return what the audit trail keeps of a passkey."""
    return {"kind": "passkey", "id": row.id, "label": row.label}


def _passkey(row: PasskeyRow) -> Passkey:
    return Passkey(
        row.id,
        row.user,
        row.label,
        row.credential,
        row.public_key,
        row.signatures,
        row.created_ns,
        row.used_ns,
    )
