"""Clocks that are off, missing records, disks, certificates and back-ups: told once, with a dead band."""

import shutil
import socket
import time
from collections.abc import Iterable
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest
from pydantic import BaseModel
from sqlalchemy import Engine, update

from core.units import NANOSECONDS_PER_DAY
from service.alarms.kinds import AlarmKind, AlarmPriority
from service.background.alarm_sources.backups import BackupSource
from service.background.alarm_sources.certificates import CertificateSource
from service.background.alarm_sources.clocks import ClockSource
from service.background.alarm_sources.disks import DiskSource, Room, days_to_full
from service.background.alarm_sources.missing_data import MissingDataSource
from service.background.alarm_sources.trips import TripSource
from service.configuration.alarms import AlarmSettings
from service.configuration.backup import BackupSettings
from service.configuration.certificate_files import certificate_files
from service.configuration.relay_access import RelayAccess, RelayTls
from service.configuration.settings import Settings
from service.plant import Schedule
from service.storage import Repository
from service.storage.models import ConditionRow
from service.storage.records import SERVICE, Alarm, AlarmPlace, AlarmSpec, ClockNote, ClockReading
from service.storage.records.alarm_sources import AlarmFinding
from service.storage.states import AlarmState, ClockQuality, LinkState
from testing.relays.certificates import identity
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant

DAY_NS = NANOSECONDS_PER_DAY
HOUR_NS = DAY_NS // 24
RELAY, MOTOR = "A1_SEL710", "PUMP-A1"


class Table:
    """The table of alarms, into which what a source finds is written."""

    def __init__(self, repository: Repository) -> None:
        self.repository = repository

    def settle(self, findings: Iterable[AlarmFinding], now_ns: int = NOW_NS) -> list[Alarm]:
        """Write the findings; return what stands then."""
        self.repository.settle_findings(tuple(findings), now_ns=now_ns)
        return list(self.repository.alarms(limit=100, standing=True).items)


@pytest.fixture
def table(repository: Repository) -> Table:
    return Table(repository)


def read_clock(
    repository: Repository,
    offset_s: float,
    within_s: float,
    quality: ClockQuality = ClockQuality.SYNCHRONISED,
) -> None:
    reading = ClockReading(round(offset_s * SECOND_NS), round(within_s * SECOND_NS), quality, NOW_NS)
    repository.note_clocks([ClockNote(RELAY, reading)])


def test_a_clock_is_off_only_where_that_is_sure(table: Table) -> None:
    source = ClockSource(AlarmSettings(), table.repository)
    assert table.settle(source.findings()) == []
    read_clock(table.repository, -7.0, 2.5)
    assert table.settle(source.findings()) == []
    read_clock(table.repository, -8.0, 2.5)
    (alarm,) = table.settle(source.findings())
    assert (alarm.kind, alarm.ied) == (AlarmKind.CLOCK_OFF, RELAY)
    assert alarm.reason == (
        "the relay's clock is 8.0 s behind (+-2.5 s), measured 2025-10-09T08:53:20Z; the relay says it is "
        "synchronised"
    )
    read_clock(table.repository, -2.6, 2.5)
    assert len(table.settle(source.findings())) == 1
    read_clock(table.repository, -2.4, 2.5)
    assert table.settle(source.findings()) == []
    read_clock(table.repository, 0.0, 0.1, ClockQuality.FAILED)
    (alarm,) = table.settle(source.findings())
    assert alarm.reason == "the relay says that its clock has failed"


def test_records_are_missing_when_the_schedule_promised_them(
    engine: Engine, table: Table, tmp_path: Path
) -> None:
    plant = two_motor_plant()
    daily = replace(plant.motors[0], schedule=Schedule.parse("0 6 * * *"))
    table.repository.sync_plant(replace(plant, motors=(daily, plant.motors[1])))
    set_link_state(table.repository, RELAY, LinkState.UP, None, now_ns=NOW_NS - 30 * DAY_NS)
    source = MissingDataSource(Settings(data_directory=tmp_path), table.repository, NOW_NS)

    def latest(column: str, time_ns: int) -> None:
        with engine.begin() as connection:
            row = update(ConditionRow).where(ConditionRow.motor == MOTOR)
            connection.execute(row.values({column: time_ns}))

    overdue_ns = round(2.5 * DAY_NS)
    assert table.settle(source.findings(NOW_NS + overdue_ns)) == []
    (alarm,) = table.settle(source.findings(NOW_NS + overdue_ns + 1))
    assert (alarm.kind, alarm.motor) == (AlarmKind.MISSING_DATA, MOTOR)
    assert alarm.reason == "there is no valid record yet; scheduled at 06:00 every day (UTC)"
    latest("as_of_ns", NOW_NS + DAY_NS)
    assert table.settle(source.findings(NOW_NS + DAY_NS + overdue_ns)) == []
    latest("stood_ns", NOW_NS + 2 * DAY_NS)  # a motor that stands makes no record
    assert table.settle(source.findings(NOW_NS + 2 * DAY_NS + overdue_ns)) == []
    (alarm,) = table.settle(source.findings(NOW_NS + 2 * DAY_NS + overdue_ns + 1))
    assert alarm.reason.startswith("the latest valid record is of 2025-10-10T08:53:20Z")


def test_while_a_link_is_down_and_just_after_nothing_is_missing(table: Table, tmp_path: Path) -> None:
    plant = two_motor_plant()
    daily = replace(plant.motors[0], schedule=Schedule.parse("0 6 * * *"))
    table.repository.sync_plant(replace(plant, motors=(daily,)))
    source = MissingDataSource(Settings(data_directory=tmp_path), table.repository, NOW_NS)
    set_link_state(table.repository, RELAY, LinkState.DOWN, "refused", now_ns=NOW_NS)
    assert table.settle(source.findings(NOW_NS + 6 * DAY_NS)) == []
    set_link_state(table.repository, RELAY, LinkState.UP, None, now_ns=NOW_NS + 6 * DAY_NS)
    assert table.settle(source.findings(NOW_NS + 7 * DAY_NS)) == []
    assert len(table.settle(source.findings(NOW_NS + 8 * DAY_NS))) == 1


def test_what_no_schedule_promises_is_not_missing(table: Table, tmp_path: Path) -> None:
    for days, number in ((None, 0), (10.0, 2)):
        settings = Settings(data_directory=tmp_path, stale_after_days=days)
        for relay in (RELAY, "A2_SEL710"):
            set_link_state(table.repository, relay, LinkState.UP, None, now_ns=NOW_NS)
        source = MissingDataSource(settings, table.repository, NOW_NS)
        assert len(table.settle(source.findings(NOW_NS + 100 * DAY_NS))) == number


def test_a_disk_with_little_room_is_told(table: Table, tmp_path: Path) -> None:
    usage = shutil.disk_usage(tmp_path)
    free = usage.free / usage.total

    def source(share: float) -> DiskSource:
        rules = AlarmSettings(disk_free_share=share)
        return DiskSource(rules, table.repository, [tmp_path, tmp_path, tmp_path / "missing"])

    assert table.settle(source(free / 2.0).findings(0.0)) == []
    if free < 0.85:
        (alarm,) = table.settle(source(min(0.9, free + 0.04)).findings(0.0))
        assert (alarm.kind, alarm.site, alarm.ied, alarm.motor) == (AlarmKind.DISK_FILLING, None, None, None)
        assert alarm.subject == f"{socket.gethostname()}: {tmp_path}"
        assert alarm.reason == f"{free:.0%} of the disk is free"
        assert len(table.settle(source(free / 1.1).findings(0.0))) == 1
        assert table.settle(source(free / 1.3).findings(0.0)) == []


def test_how_fast_a_disk_fills_is_told_from_an_hour_at_least() -> None:
    filling = [Room(60.0 * minute, 10**12 - minute * 10**8) for minute in range(121)]
    assert days_to_full(filling[:60]) is None
    days = days_to_full(filling)
    assert days == pytest.approx((10**12 - 120 * 10**8) / 10**8 / 1440, rel=1e-6)
    assert days_to_full([Room(room.at_s, 10**12) for room in filling]) is None
    assert days_to_full([]) is None


def test_certificates_of_relays_are_told_before_they_end(table: Table, tmp_path: Path) -> None:
    lasting = identity(tmp_path, "lasting", until=timedelta(days=400))
    ending = identity(tmp_path, "ending", until=timedelta(days=20))
    ended = identity(tmp_path, "ended", since=timedelta(days=-30), until=timedelta(days=-1))

    def source(*pinned: Path) -> CertificateSource:
        tls = RelayTls(certificate=lasting.certificate_file, key=lasting.key_file, pinned=pinned)
        relays = {name: RelayAccess(tls=tls) for name in (RELAY, "A2_SEL710", "B1", "B2")}
        return CertificateSource(Settings(data_directory=tmp_path, relays=relays), table.repository)

    now_ns = time.time_ns()
    both = source(ending.certificate_file, ended.certificate_file, tmp_path / "none.pem")
    alarms = {
        Path(one.subject.split(": ")[1]).name: one for one in table.settle(both.findings(now_ns), now_ns)
    }
    assert {name: one.priority for name, one in alarms.items()} == {
        ending.certificate_file.name: AlarmPriority.MEDIUM,
        ended.certificate_file.name: AlarmPriority.HIGH,
        "none.pem": AlarmPriority.HIGH,
    }
    told = alarms[ending.certificate_file.name]
    assert told.reason.startswith("ends ")
    assert told.reason.endswith("Z (for relay A1_SEL710, relay A2_SEL710, relay B1 and 1 others)")
    assert alarms[ended.certificate_file.name].reason.startswith("ended ")
    table.repository.acknowledge_alarm(told.id, by=SERVICE, now_ns=now_ns)
    later_ns = now_ns + 14 * DAY_NS
    table.settle(both.findings(later_ns), later_ns)
    again = table.repository.alarm(told.id)
    assert (again.priority, again.state) == (AlarmPriority.HIGH, AlarmState.UNACKNOWLEDGED)
    assert table.settle(source(lasting.certificate_file).findings(now_ns), now_ns) == []


class OfMail(BaseModel):
    ca: Path


class OfService(BaseModel):
    channels: dict[str, OfMail]


def test_every_certificate_that_settings_name_is_looked_at() -> None:
    mail = OfMail(ca=Path("/ca.pem"))
    both = OfService(channels={"ops": mail, "boss": mail})
    assert certificate_files(both) == {Path("/ca.pem"): ["[channels.ops]", "[channels.boss]"]}
    own = Settings(tls_certificate=Path("/own.pem"), tls_key=Path("/own.key"))
    assert certificate_files(own) == {Path("/own.pem"): ["the REST API"]}


def test_a_back_up_is_overdue_only_where_one_is_expected(table: Table, tmp_path: Path) -> None:
    def source(*, expected: bool = True) -> BackupSource:
        settings = BackupSettings(directory=tmp_path if expected else None)
        return BackupSource(settings, table.repository, NOW_NS)

    assert table.settle(source(expected=False).findings(NOW_NS + 100 * DAY_NS)) == []
    assert table.settle(source().findings(NOW_NS + 2 * DAY_NS)) == []
    (alarm,) = table.settle(source().findings(NOW_NS + 2 * DAY_NS + 1))
    assert alarm.reason == f"no back-up was ever made and verified ({tmp_path})"
    backup = table.repository.begin_backup(str(tmp_path), now_ns=NOW_NS + 3 * DAY_NS)
    assert backup is not None
    table.repository.finish_backup(
        backup.id, name="one", recordings=1, files=2, size_bytes=3, now_ns=NOW_NS + 3 * DAY_NS
    )
    assert table.settle(source().findings(NOW_NS + 4 * DAY_NS)) == []
    (alarm,) = table.settle(source().findings(NOW_NS + 6 * DAY_NS))
    assert alarm.reason == f"the latest verified back-up is of 2025-10-12T08:53:20Z ({tmp_path})"
    assert table.settle(source(expected=False).findings(NOW_NS + 6 * DAY_NS)) == []


def test_a_trip_is_over_when_its_motor_leaves_the_plant(table: Table) -> None:
    source, plant = TripSource(table.repository), two_motor_plant()
    spec = AlarmSpec(AlarmKind.MOTOR_TRIPPED, "PTRC1.Tr is on", "PTRC1.Tr")
    for motor in plant.motors:
        table.repository.raise_alarm_at(AlarmPlace(motor=motor.name), spec, now_ns=NOW_NS)
    assert len(table.settle(source.findings())) == 2
    table.repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    (alarm,) = table.settle(source.findings())
    assert alarm.motor == plant.motors[1].name
