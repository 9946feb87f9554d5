"""Sites, relays and motors."""

from collections.abc import Mapping, Sequence

from sqlalchemy import bindparam, func, select, update

from service.plant import Plant, PlantMotor, Schedule
from service.storage.engine import one_at_a_time
from service.storage.models import ConditionRow, IedRow, MotorRow, SiteRow
from service.storage.records import (
    SERVICE,
    ClockNote,
    Cursor,
    IedEntry,
    MotorEntry,
    Page,
    ReportPosition,
    SiteEntry,
)
from service.storage.repository.audit.plant_changes import note_plant_changes, plant_in_service
from service.storage.repository.conditions.conditions import new_condition
from service.storage.repository.conditions.fold_marks import EARLIEST_NS, mark
from service.storage.repository.sessions import Sessions, columns_of, found, page_of, record_of
from service.storage.states import LinkState

_CLOCKS = (
    update(IedRow)
    .where(IedRow.name == bindparam("of"))
    # a reading that waited replaces none that was made since
    .where(func.coalesce(IedRow.clock_measured_ns, 0) <= bindparam("measured_ns"))
    .values(
        clock_offset_ns=bindparam("offset_ns"),
        clock_uncertainty_ns=bindparam("uncertainty_ns"),
        clock_quality=bindparam("quality"),
        clock_measured_ns=bindparam("measured_ns"),
    )
)
_POSITIONS = (
    update(IedRow)
    .where(IedRow.name == bindparam("of"))
    .values(entry_id=bindparam("new_entry_id"), entry_report_control=bindparam("new_report_control"))
)


class PlantRows(Sessions):
    def sync_plant(self, plant: Plant, *, noted_ns: int | None = None) -> None:
        """Make the tables say what the plant's files say.

        What left the plant is put out of service, not deleted: its recordings stay, and those
        of a motor that are yet to be observed never are. Motors of a bus that
        others joined or left are folded anew, because what its motors see is compared.

        noted_ns: the audit trail keeps what differs, as of this time; None: it keeps nothing.
        """
        with self._write() as session:
            one_at_a_time(session.connection(), "sync plant")
            before = plant_in_service(session)
            for table in (SiteRow, IedRow, MotorRow):
                session.execute(update(table).values(in_service=False))
            for site in plant.sites:
                session.merge(SiteRow(name=site.name, description=site.description, in_service=True))
            session.flush()
            for relay in plant.relays:
                row = session.get(IedRow, relay.name)
                if row is None:
                    row = IedRow(name=relay.name, link_state=LinkState.UNKNOWN)
                    session.add(row)
                row.site, row.host, row.port = relay.site, relay.host, relay.port
                row.manufacturer, row.type, row.in_service = relay.manufacturer, relay.type, True
            session.flush()
            buses_before = {row.name: row.bus for row in session.scalars(select(MotorRow))}
            for motor in plant.motors:
                schedule = _schedule_of(motor, plant)
                session.merge(
                    MotorRow(
                        name=motor.name,
                        description=motor.description,
                        site=motor.site,
                        ied=motor.relay,
                        in_service=True,
                        schedule=None if schedule is None else schedule.expression,
                        bus=_compared_on(plant, motor),
                        parameters_source=motor.motor.parameters_source,
                    )
                )
            session.flush()
            if noted_ns is not None:
                note_plant_changes(session, before, SERVICE, now_ns=noted_ns)
            for name in _of_changed_buses(buses_before, plant):
                mark(session, name, EARLIEST_NS)
            for motor in plant.motors:
                if session.get(ConditionRow, motor.name) is None:
                    session.add(new_condition(motor.name))

    def note_clocks(self, notes: Sequence[ClockNote]) -> None:
        """Note readings of relays' clocks. An unknown relay is passed over."""
        if not notes:
            return
        with self._write() as session:
            session.connection().execute(
                _CLOCKS,
                [
                    {
                        "of": note.ied,
                        "offset_ns": note.reading.offset_ns,
                        "uncertainty_ns": note.reading.uncertainty_ns,
                        "quality": note.reading.quality,
                        "measured_ns": note.reading.measured_ns,
                    }
                    for note in notes
                ],
            )

    def entry_id(self, relay: str, report_control: str | None = None) -> bytes | None:
        """Return the EntryID of the last buffered report whose records are stored; None for another block's.

        Each block has a buffer of its own. Raises NotFoundError.
        """
        with self._read() as session:
            row = found(session, IedRow, relay, "relay")
            unknown = report_control is None or row.entry_report_control is None
            return row.entry_id if unknown or row.entry_report_control == report_control else None

    def save_report_positions(self, positions: Sequence[ReportPosition]) -> None:
        """Save where to resume the buffered reports of blocks. An unknown relay is passed over."""
        if not positions:
            return
        with self._write() as session:
            session.connection().execute(
                _POSITIONS,
                [
                    {
                        "of": each.ied,
                        "new_entry_id": each.entry_id,
                        "new_report_control": each.report_control,
                    }
                    for each in positions
                ],
            )

    def sites(self, *, limit: int, after: Cursor | None = None) -> Page[SiteEntry]:
        with self._read() as session:
            query = select(*columns_of(SiteEntry, SiteRow)).where(SiteRow.in_service)
            return page_of(session, query, [SiteRow.name], SiteEntry, limit=limit, after=after)

    def relays(self, *, limit: int, after: Cursor | None = None) -> Page[IedEntry]:
        with self._read() as session:
            query = select(*columns_of(IedEntry, IedRow)).where(IedRow.in_service)
            return page_of(session, query, [IedRow.name], IedEntry, limit=limit, after=after)

    def relay(self, name: str) -> IedEntry:
        """Return a relay by its name. Raises NotFoundError."""
        with self._read() as session:
            return _relay(found(session, IedRow, name, "relay"))

    def is_in_service(self, relay: str) -> bool:
        """Tell whether a relay is in the plant's files. Raises NotFoundError."""
        with self._read() as session:
            return found(session, IedRow, relay, "relay").in_service

    def motors(self, *, limit: int, after: Cursor | None = None) -> Page[MotorEntry]:
        with self._read() as session:
            query = select(*columns_of(MotorEntry, MotorRow)).where(MotorRow.in_service)
            return page_of(session, query, [MotorRow.name], MotorEntry, limit=limit, after=after)

    def schedules(self) -> Mapping[str, str | None]:
        """Return the schedules of all motors in service, by name."""
        with self._read() as session:
            query = select(MotorRow.name, MotorRow.schedule).where(MotorRow.in_service)
            return dict(session.execute(query).all())

    def relays_of_motors(self) -> Mapping[str, str]:
        """Return the relay of each motor in service, by its name."""
        with self._read() as session:
            query = select(MotorRow.name, MotorRow.ied).where(MotorRow.in_service).order_by(MotorRow.name)
            return dict(session.execute(query).all())

    def motor(self, name: str) -> MotorEntry:
        """Return a motor by its name. Raises NotFoundError."""
        with self._read() as session:
            return _motor(found(session, MotorRow, name, "motor"))


def _relay(row: IedRow) -> IedEntry:
    return record_of(IedEntry, row)


def _motor(row: MotorRow) -> MotorEntry:
    return record_of(MotorEntry, row)


def _compared_on(plant: Plant, motor: PlantMotor) -> str | None:
    """Return the bus with whose other motors a motor is compared.

    None where they share a voltage transformer: its error looks the same to all of them, as if it were none.
    """
    bus = plant.bus_of(motor.name)
    return None if bus is not None and bus.common_voltage_transformer else motor.bus


def _schedule_of(motor: PlantMotor, plant: Plant) -> Schedule | None:
    """Return when a motor is recorded: at times of its own, or with its bus."""
    bus = plant.bus_of(motor.name)
    return motor.schedule or (None if bus is None else bus.schedule)


def _of_changed_buses(before: Mapping[str, str | None], plant: Plant) -> list[str]:
    """Return the motors known before that are, or were, on a bus which a motor joined or left."""
    now = {**before, **{motor.name: _compared_on(plant, motor) for motor in plant.motors}}
    moved = [name for name in now if before.get(name) != now[name]]
    changed = {bus for name in moved for bus in (before.get(name), now[name]) if bus is not None}
    return [name for name, bus in before.items() if changed.intersection((bus, now[name]))]
