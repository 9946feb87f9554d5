"""The relays' links: how they are, every change with its reason, and what went over them."""

import uuid
from collections.abc import Sequence
from dataclasses import asdict, fields
from operator import attrgetter

from sqlalchemy import ColumnElement, bindparam, case, delete, func, select, update
from sqlalchemy.orm import Session

from service.storage.models import IedRow, LeaseRow, LinkChangeRow, LinkFiguresRow
from service.storage.records import Cursor, LinkChange, LinkFigures, LinkNote, LinkTraffic, Page
from service.storage.repository.sessions import Order, Sessions, columns_of, found, page_of, record_of
from service.storage.states import LinkState

MOST_CHANGES = 1000
"""So many changes are kept of each link: one that changes all day must not fill the disk."""


_ANSWERED = update(IedRow).where(IedRow.name == bindparam("of")).values(last_success_ns=bindparam("at"))
_FIGURES = (
    update(LinkFiguresRow)
    .where(LinkFiguresRow.ied == bindparam("of"))
    .values(
        round_trip_s=func.coalesce(bindparam("took_s"), LinkFiguresRow.round_trip_s),
        day=bindparam("new_day"),
        day_bytes=case(  # a note that waited tells no news of a day that is known to have more
            (
                (LinkFiguresRow.day == bindparam("new_day"))
                & (LinkFiguresRow.day_bytes > bindparam("new_day_bytes")),
                LinkFiguresRow.day_bytes,
            ),
            else_=bindparam("new_day_bytes"),
        ),
        **{
            field.name: LinkFiguresRow.__table__.columns[field.name] + bindparam(f"more_{field.name}")
            for field in fields(LinkTraffic)
        },
    )
)


class LinkRows(Sessions):
    def note_links(self, notes: Sequence[LinkNote], *, gateway: str | None = None) -> None:
        """Add to the figures of links, and set the states that notes tell, in their order.

        gateway: only while it holds a relay do its notes set that link's state. Notes may wait, and whoever
        found the gateway dead has said since that the link is unknown. No times are compared: a clock may
        have been set meanwhile, and those of two hosts differ.

        A note of a link that stays up passes over an unknown relay. Raises NotFoundError.
        """
        if not notes:
            return
        with self._write() as session:
            _set_states(session, [note for note in notes if note.state is not None], gateway)
            answered = {note.ied: note.now_ns for note in notes if note.is_answer}
            if answered:  # in one order, for two who write them
                rows = [{"of": relay, "at": now_ns} for relay, now_ns in sorted(answered.items())]
                session.connection().execute(_ANSWERED, rows)
            session.connection().execute(
                _FIGURES,
                [
                    {
                        "of": note.ied,
                        "took_s": note.round_trip_s,
                        "new_day": note.day,
                        "new_day_bytes": note.day_bytes,
                        **{f"more_{name}": value for name, value in asdict(note.traffic).items()},
                    }
                    for note in sorted(notes, key=attrgetter("ied"))
                ],
            )

    def reset_links(self, *, now_ns: int, reason: str | None = None) -> None:
        """Set the link of every relay that nobody visits to unknown. The service does so when it starts."""
        with self._write() as session:
            known = select(IedRow).where(
                IedRow.link_state.not_in((LinkState.UNKNOWN, LinkState.QUARANTINED)),
                IedRow.name.not_in(select(LeaseRow.ied)),
            )
            change_links(session, session.scalars(known).all(), LinkState.UNKNOWN, reason, now_ns)

    def link_changes(self, relay: str, *, limit: int, after: Cursor | None = None) -> Page[LinkChange]:
        """Return the changes of a relay's link, latest first. Raises NotFoundError."""
        query = select(*columns_of(LinkChange, LinkChangeRow)).where(LinkChangeRow.ied == relay)
        order: Order = [LinkChangeRow.changed_ns, LinkChangeRow.id]
        with self._read() as session:
            found(session, IedRow, relay, "relay")
            return page_of(session, query, order, LinkChange, limit=limit, after=after, descending=True)

    def link_figures(self, relay: str) -> LinkFigures:
        """Return what went over a relay's link; zeros before anything did. Raises NotFoundError."""
        with self._read() as session:
            found(session, IedRow, relay, "relay")
            row = session.get(LinkFiguresRow, relay)
            return LinkFigures(relay) if row is None else record_of(LinkFigures, row)

    def all_link_figures(self) -> tuple[LinkFigures, ...]:
        """Return the figures of every relay in service that was ever spoken to, by name."""
        query = (
            select(*columns_of(LinkFigures, LinkFiguresRow))
            .join(IedRow, IedRow.name == LinkFiguresRow.ied)
            .where(IedRow.in_service)
            .order_by(LinkFiguresRow.ied)
        )
        with self._read() as session:
            return tuple(LinkFigures(*row) for row in session.execute(query))


def _set_states(session: Session, notes: Sequence[LinkNote], gateway: str | None) -> None:
    """Set the states that the notes tell. Hundreds of links may come up at once: a statement serves all."""
    if not notes:
        return
    relays = {note.ied for note in notes}
    rows = {row.name: row for row in locked_relays(session, IedRow.name.in_(relays))}
    held = select(LeaseRow.ied).where(LeaseRow.ied.in_(relays), LeaseRow.gateway == gateway)
    told = relays if gateway is None else set(session.scalars(held))
    with_figures = set(session.scalars(select(LinkFiguresRow.ied).where(LinkFiguresRow.ied.in_(relays))))
    zeros = {field.name: 0 for field in fields(LinkTraffic)}
    for note in notes:
        row = rows.get(note.ied) or found(session, IedRow, note.ied, "relay")
        if note.state is not None and note.ied in told:
            _change_link(session, row, note.state, note.reason, note.now_ns)
        if note.ied not in with_figures:
            with_figures.add(note.ied)
            session.add(LinkFiguresRow(ied=note.ied, day=note.day, day_bytes=0, **zeros))
    _write_changes(session)


def locked_relays(session: Session, condition: ColumnElement[bool]) -> Sequence[IedRow]:
    """Return relays whose links nobody else changes until the transaction ends."""
    query = select(IedRow).where(condition).order_by(IedRow.name)  # in one order, for two who lock them
    return session.scalars(query.with_for_update(key_share=True)).all()


def change_links(
    session: Session, rows: Sequence[IedRow], state: LinkState, reason: str | None, now_ns: int
) -> None:
    """Set the state of links, and add it to the history of those that it changes."""
    for row in rows:
        _change_link(session, row, state, reason, now_ns)
    _write_changes(session)


def _change_link(session: Session, row: IedRow, state: LinkState, reason: str | None, now_ns: int) -> None:
    if row.link_state is state and row.link_reason == reason:
        return
    if row.link_state is not state:
        row.link_changed_ns = now_ns
    row.link_state, row.link_reason = state, reason
    session.add(
        LinkChangeRow(id=str(uuid.uuid4()), ied=row.name, changed_ns=now_ns, state=state, reason=reason)
    )


def _write_changes(session: Session) -> None:
    """Write what the session holds, and drop the changes beyond MOST_CHANGES of those links that changed."""
    changed = {row.ied for row in session.new if isinstance(row, LinkChangeRow)}
    session.flush()
    crowded = (
        select(LinkChangeRow.ied)
        .where(LinkChangeRow.ied.in_(changed))
        .group_by(LinkChangeRow.ied)
        .having(func.count() > MOST_CHANGES)
    )
    for relay in session.scalars(crowded).all() if changed else ():
        too_old = (
            select(LinkChangeRow.id)
            .where(LinkChangeRow.ied == relay)
            .order_by(LinkChangeRow.changed_ns.desc(), LinkChangeRow.id.desc())
            .offset(MOST_CHANGES)
        )
        session.execute(delete(LinkChangeRow).where(LinkChangeRow.id.in_(session.scalars(too_old).all())))
