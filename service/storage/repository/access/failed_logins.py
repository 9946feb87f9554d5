"""Failed logins in a row, counted before a password is looked at, so that a thousand at once count too."""

import hashlib
from collections.abc import Iterator, Mapping
from ipaddress import IPv6Address, IPv6Network, ip_address
from typing import Final

from sqlalchemy import delete, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.storage.models import FailedLoginRow, UserRow
from service.storage.records import Actor, LoginLimits
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, only

Key = tuple[str, str]
"""Account and address, of which one may be "" for all."""

UNKNOWN = "(no such user)"
"""The audit trail has this in place of a name that no user has: it may be a password, in the wrong field."""


def account_key(name: str) -> str:
    """Return what stands for an account here; not its name, for the reason of UNKNOWN."""
    return hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()


IPV6_OF_A_CUSTOMER: Final = 64
"""Bits of an IPv6 address that whoever has the network cannot choose."""


def counted_address(origin: str) -> str:
    """Return what failed logins are counted by: an IPv6 network of one customer counts as one address.

    origin: an address as the audit trail has it, perhaps with the name of a gateway and a blank before it.
    """
    gateway, blank, host = origin.rpartition(" ")
    try:
        found = ip_address(host)
    except ValueError:
        return origin
    if not isinstance(found, IPv6Address) or found.ipv4_mapped is not None:
        return origin
    return f"{gateway}{blank}{IPv6Network((int(found), IPV6_OF_A_CUSTOMER), strict=False)}"


class FailedLoginRows(Sessions):
    def attempt_login(self, account: str, origin: str, limits: LoginLimits, *, now_ns: int) -> int | None:
        """Count an attempt as failed, until it has succeeded; return None, or until when none is tried.

        An account that many addresses fail at is still open to the address of its last login.
        """
        address = counted_address(origin)
        allowed = _allowed(account_key(account), address, limits)
        with self._read() as session:
            locked = _locked_until(session, account, address, now_ns)
        if locked is not None:
            return locked
        with self._write() as session:
            forgotten_ns = now_ns - round(limits.forget_s * NANOSECONDS_PER_SECOND)
            session.execute(delete(FailedLoginRow).where(FailedLoginRow.last_ns < forgotten_ns))
            rows = dict(_counted(session, allowed, now_ns))
            locked = _locked_until(session, account, address, now_ns)
            if locked is not None:
                return locked
            for key, row in rows.items():
                row.failures += 1
                row.last_ns = now_ns
                surplus = row.failures - allowed[key]
                if surplus >= 0:
                    lock_s = min(limits.least_s * 2.0 ** min(surplus, 30), limits.most_s)
                    row.locked_until_ns = now_ns + round(lock_s * NANOSECONDS_PER_SECOND)
                    told = {"address": key[1], "failures": row.failures, "seconds": lock_s}
                    subject = _known(session, account) if key[0] else ""
                    by = Actor(_known(session, account), origin)
                    note_change(
                        session, by, AuditAction.LOGIN_LOCKED, ("user", subject), now_ns=now_ns, after=told
                    )
            return None

    def note_login_failed(self, account: str, origin: str, reason: str, *, now_ns: int) -> None:
        """Note why a login failed; it is counted already."""
        with self._write() as session:
            name = _known(session, account)
            note_change(
                session,
                Actor(name, origin),
                AuditAction.LOGIN_FAILED,
                ("user", name),
                now_ns=now_ns,
                after={"reason": reason},
            )

    def forget_attempt(self, account: str, origin: str) -> None:
        """Take back an attempt that succeeded: nothing is held against this account at this address."""
        address = counted_address(origin)
        pair = (account_key(account), address)
        with self._write() as session:
            for key in sorted((pair, (pair[0], ""), ("", address))):
                query = select(FailedLoginRow).filter_by(account=key[0], address=key[1]).with_for_update()
                row = only(session, query)
                if row is None:
                    continue
                if key == pair:
                    session.delete(row)
                    continue
                row.failures -= 1
                row.locked_until_ns = 0

    def locked_until(self, account: str, *, now_ns: int) -> int | None:
        """Return until when no login of an account is tried from some address; None where all are."""
        query = select(FailedLoginRow.locked_until_ns).where(
            FailedLoginRow.account == account_key(account), FailedLoginRow.locked_until_ns > now_ns
        )
        with self._read() as session:
            return max(session.scalars(query), default=None)


def _known(session: Session, account: str) -> str:
    return account if session.get(UserRow, account) is not None else UNKNOWN


def _allowed(account: str, address: str, limits: LoginLimits) -> Mapping[Key, int]:
    return {
        (account, address): limits.of_account_and_address,
        (account, ""): limits.of_account,
        ("", address): limits.of_address,
    }


def _locked_until(session: Session, account: str, address: str, now_ns: int) -> int | None:
    key = account_key(account)
    keys = [(key, address), ("", address)]
    last_origin = session.scalar(select(UserRow.last_login_origin).where(UserRow.name == account))
    if last_origin is None or counted_address(last_origin) != address:
        keys.append((key, ""))
    found = [session.get(FailedLoginRow, key) for key in keys]
    return max((row.locked_until_ns for row in found if row and row.locked_until_ns > now_ns), default=None)


def _counted(session: Session, keys: Mapping[Key, int], now_ns: int) -> Iterator[tuple[Key, FailedLoginRow]]:
    """Yield the rows of the keys, new ones where there are none; others who want them wait."""
    insert = sqlite.insert if session.get_bind().dialect.name == "sqlite" else postgresql.insert
    for account, address in sorted(keys):  # in one order, for two who lock them
        session.execute(
            insert(FailedLoginRow)
            .values(account=account, address=address, failures=0, last_ns=now_ns, locked_until_ns=0)
            .on_conflict_do_nothing()
        )
        query = select(FailedLoginRow).filter_by(account=account, address=address).with_for_update()
        yield (account, address), session.scalars(query.execution_options(populate_existing=True)).one()
