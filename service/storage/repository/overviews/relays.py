"""Relays with their link, latest record, quarantine and findings; and a link over time."""

from collections.abc import Sequence

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session, aliased

from service.storage.models import (
    IedRow,
    LinkChangeRow,
    MotorRow,
    QuarantineRow,
    RecordingRow,
    RelayFindingsRow,
    StandingAlarmCountRow,
)
from service.storage.records import Cursor, IedEntry, LinkChange, Page, Quarantine
from service.storage.records.overviews import RelayOverview
from service.storage.repository.sessions import Sessions, columns_of, found, page_of
from service.storage.states import LinkState


class RelayOverviewRows(Sessions):
    def relay_overviews(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        site: str | None = None,
        link: LinkState | None = None,
        text: str | None = None,
        differing: bool = False,
    ) -> Page[RelayOverview]:
        """Return a page of the relays in service, by name.

        site, link: only relays there, or with such a link. text: only those whose own name, or a motor's, has
        it in it; None for all. differing: only those that differ from their SCL.
        """
        query = select(*columns_of(IedEntry, IedRow)).where(IedRow.in_service)
        if site is not None:
            query = query.where(IedRow.site == site)
        if link is not None:
            query = query.where(IedRow.link_state == link)
        if text is not None:
            of_motor = select(MotorRow.ied).where(
                MotorRow.in_service, MotorRow.name.icontains(text, autoescape=True)
            )
            query = query.where(or_(IedRow.name.icontains(text, autoescape=True), IedRow.name.in_(of_motor)))
        if differing:
            differ = func.json_array_length(RelayFindingsRow.differences) > 0
            query = query.where(IedRow.name.in_(select(RelayFindingsRow.ied).where(differ)))
        with self._read() as session:
            relays = page_of(session, query, [IedRow.name], IedEntry, limit=limit, after=after)
            return Page(_overviews(session, relays.items), relays.next)

    def relay_overview(self, name: str) -> RelayOverview:
        """Return one relay, in service or not. Raises NotFoundError."""
        query = select(*columns_of(IedEntry, IedRow)).where(IedRow.name == name)
        with self._read() as session:
            found(session, IedRow, name, "relay")
            entry = IedEntry(*session.execute(query).one())
            (overview,) = _overviews(session, [entry])
            return overview

    def link_states(self) -> dict[LinkState, int]:
        """Return how many relays in service have a link in each state; a state that none has is left out."""
        query = select(IedRow.link_state, func.count()).where(IedRow.in_service).group_by(IedRow.link_state)
        with self._read() as session:
            return dict(session.execute(query).all())

    def visited_relays(self) -> tuple[int, int]:
        """Return of how many relays in service something was found, and how many there are."""
        there = select(func.count()).select_from(IedRow).where(IedRow.in_service)
        with self._read() as session:
            visited = there.join(RelayFindingsRow, RelayFindingsRow.ied == IedRow.name)
            return session.scalar(visited) or 0, session.scalar(there) or 0

    def link_history(self, relay: str, *, from_ns: int) -> tuple[LinkChange, ...]:
        """Return the changes of a link from a time on, oldest first, and before them the last earlier one.

        The latest thousand are kept: where the first one is later than from_ns, nothing is known of the time
        before it. Raises NotFoundError.
        """
        query = select(*columns_of(LinkChange, LinkChangeRow)).where(LinkChangeRow.ied == relay)
        order = (LinkChangeRow.changed_ns, LinkChangeRow.id)
        later = query.where(LinkChangeRow.changed_ns >= from_ns).order_by(*order)
        earlier = query.where(LinkChangeRow.changed_ns < from_ns)
        with self._read() as session:
            found(session, IedRow, relay, "relay")
            before = session.execute(earlier.order_by(*(one.desc() for one in order)).limit(1)).all()
            return tuple(LinkChange(*row) for row in (*before, *session.execute(later).all()))


def _overviews(session: Session, relays: Sequence[IedEntry]) -> tuple[RelayOverview, ...]:
    """Return what is known of each relay from a few queries, however many relays there are."""
    names = [relay.name for relay in relays]
    motors: dict[str, list[str]] = {}
    of_relays = select(MotorRow.ied, MotorRow.name).where(MotorRow.ied.in_(names), MotorRow.in_service)
    for relay, motor in session.execute(of_relays.order_by(MotorRow.name)):
        motors.setdefault(relay, []).append(motor)
    latest = _latest_records(session, names)
    held = select(*columns_of(Quarantine, QuarantineRow)).where(QuarantineRow.ied.in_(names))
    quarantines = {row.ied: Quarantine(*row) for row in session.execute(held)}
    counted = select(
        RelayFindingsRow.ied,
        func.json_array_length(RelayFindingsRow.differences),
        RelayFindingsRow.ignored_in_all,
    ).where(RelayFindingsRow.ied.in_(names))
    findings = {ied: (differences, ignored) for ied, differences, ignored in session.execute(counted)}
    alarms = dict(
        session.execute(
            select(StandingAlarmCountRow.ied, func.sum(StandingAlarmCountRow.number))
            .where(StandingAlarmCountRow.ied.in_(names))
            .group_by(StandingAlarmCountRow.ied)
        ).all()
    )
    return tuple(
        RelayOverview(
            relay=relay,
            motors=tuple(motors.get(relay.name, ())),
            last_record_ns=latest.get(relay.name),
            quarantine=quarantines.get(relay.name),
            differences=findings.get(relay.name, (None, None))[0],
            ignored_files=findings.get(relay.name, (None, None))[1],
            standing_alarms=int(alarms.get(relay.name, 0)),
        )
        for relay in relays
    )


def _latest_records(session: Session, relays: Sequence[str]) -> dict[str, int]:
    """Return the time of each relay's latest record; the index of its motors' recordings finds it."""
    recording = aliased(RecordingRow)
    latest = (
        select(recording.id)
        .where(
            recording.motor == MotorRow.name,
            recording.ied == MotorRow.ied,
            recording.digest.is_not(None),
        )
        .order_by(recording.announced_ns.desc(), recording.id.desc())
        .limit(1)
        .scalar_subquery()
    )
    time_ns = func.coalesce(RecordingRow.recorded_ns, RecordingRow.announced_ns)
    query = (
        select(RecordingRow.ied, func.max(time_ns))
        .where(RecordingRow.id.in_(select(latest).select_from(MotorRow).where(MotorRow.ied.in_(relays))))
        .group_by(RecordingRow.ied)
    )
    return {relay: found_ns for relay, found_ns in session.execute(query) if relay is not None}
