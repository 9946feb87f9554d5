"""Tables of the audit trail. Triggers in the database refuse to change or delete an entry."""

from sqlalchemy import CheckConstraint, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


class AuditEntryRow(Base):
    """One entry; it has the hash of the entry before it, and its own."""

    __tablename__ = "audit_entries"

    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    time_ns: Mapped[int]
    actor: Mapped[str]
    origin: Mapped[str]
    roles: Mapped[str]
    action: Mapped[str] = mapped_column(String(64))
    subject_kind: Mapped[str] = mapped_column(String(64))
    subject: Mapped[str]
    before: Mapped[str | None] = mapped_column(Text)
    after: Mapped[str | None] = mapped_column(Text)
    previous: Mapped[str] = mapped_column(String(64))
    hash: Mapped[str] = mapped_column(String(64))

    __table_args__ = (
        Index(None, "actor", "number"),
        Index(None, "action", "number"),
        Index(None, "subject", "number"),
    )


class AuditHeadRow(Base):
    """The last entry: the one row of its table. Who adds an entry locks it, so that none comes between."""

    __tablename__ = "audit_head"

    id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    number: Mapped[int]
    hash: Mapped[str] = mapped_column(String(64))

    __table_args__ = (CheckConstraint("id = 1", name="only_row"),)


class AuditForwardingRow(Base):
    """The last entry that the syslog server has: the one row of its table; 0 before the first."""

    __tablename__ = "audit_forwarding"

    id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    number: Mapped[int]
