"""A controlling station that knows only the standard's octets is told of the motors."""

import os
import re
import signal
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from service.configuration.gateways.iec104 import Iec104Settings
from service.gateways.iec104.gateway import KINDS
from service.gateways.iec104.points import (
    BLOCK,
    FIRST,
    LIKELY_PHASES,
    POINTS,
    QUALITIES,
    RELAY_ANSWERS,
    said_of,
)
from service.gateways.plant_state.reading import read_plant_state
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, LinkState
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.service.iec104_master import (
    FLOAT,
    INTERROGATED,
    INVALID,
    NOT_TOPICAL,
    PLAIN_FLOAT,
    PLAIN_SINGLE,
    PLAIN_WHOLE,
    REQUESTED,
    SINGLE,
    SPONTANEOUS,
    Master,
)
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS
from testing.waiting import eventually, wait_until
from tests.service.gateways.settings import port_of, settings_of

FAN, PUMP = FIRST, FIRST + BLOCK
ALARMED = 10
"""Offset of the point that an alarm calls for somebody."""
PAGE = Path(__file__).parents[4] / "docs" / "integration.md"


@pytest.fixture
def port(repository: Repository, tmp_path: Path) -> Iterator[int]:
    chosen = settings_of("iec104", tmp_path)
    with running_gateways(chosen):
        yield port_of(chosen)


def test_everything_is_told_when_asked_and_each_value_with_the_time_of_the_record(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, FAULT)
    chosen = settings_of("iec104", tmp_path, common_address=7)
    with running_gateways(chosen), closing(Master(LOOPBACK, port_of(chosen))) as master:
        master.interrogate(7)
        told = dict(master.told)
        level_read, link_read = master.read(PUMP + 2, 7), master.read(FAN + RELAY_ANSWERS, 7)
    assert sorted(told) == [one + offset for one in (FAN, PUMP) for offset in range(len(KINDS))]
    watch, fault, level, low, high = (told[PUMP + offset] for offset in range(5))
    assert (watch.value, fault.value, fault.quality, fault.cause) == (1, 1, 0, INTERROGATED)
    assert (level.value, low.value, high.value) == pytest.approx((1.21, 0.9, 2.25))
    assert (told[PUMP + 8].value, told[PUMP + 9].value) == (1, 2)
    assert told[PUMP + 7].quality & INVALID, "the load is not known"
    assert all(told[FAN + offset].quality & INVALID for offset in range(8)), "nothing is known"
    assert told[FAN + RELAY_ANSWERS].quality & INVALID
    assert {one.kind for one in told.values()} == {PLAIN_SINGLE, PLAIN_WHOLE, PLAIN_FLOAT}
    assert not any(one.tag for one in told.values()), "no type with a time answers an interrogation"
    assert (level_read.kind, level_read.cause, level_read.value) == (FLOAT, REQUESTED, level.value)
    assert level_read.time.timestamp() * 10**9 == NOW_NS
    assert (link_read.kind, link_read.is_time_invalid) == (SINGLE, True), "its link was never seen"


def test_a_change_is_told_by_itself_and_nothing_else(repository: Repository, port: int) -> None:
    tell(repository, HEALTHY)
    with closing(Master(LOOPBACK, port)) as master:

        def state() -> int:
            master.interrogate()
            return master.told[PUMP].quality

        assert eventually(lambda: state() == 0)
        # Changes are told one after the other: once this one is, none of the condition is under way any more.
        set_link_state(repository, "A1_SEL710", LinkState.DOWN, now_ns=NOW_NS, reason="no answer")
        while master.told[PUMP + RELAY_ANSWERS].cause != SPONTANEOUS:
            master.next_change()
        master.told.clear()
        set_link_state(repository, "A1_SEL710", LinkState.UP, now_ns=NOW_NS + 1, reason=None)
        master.next_change()
    assert {place: (one.value, one.cause) for place, one in master.told.items()} == {
        PUMP + RELAY_ANSWERS: (1, SPONTANEOUS)
    }
    assert master.told[PUMP + RELAY_ANSWERS].kind == SINGLE


@pytest.mark.parametrize("stale_after_days", [3650, 0.01])
def test_an_alarm_has_the_time_when_it_was_read_and_is_good_whatever_the_records_are(
    repository: Repository, tmp_path: Path, stale_after_days: float
) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec104", tmp_path).model_copy(update={"stale_after_days": stale_after_days})
    with running_gateways(chosen), closing(Master(LOOPBACK, port_of(chosen))) as master:
        assert [master.read(one + ALARMED).value for one in (FAN, PUMP)] == [0, 0]
        raised_s = time.time()
        for motor in ("PUMP-A1", "FAN-A2"):
            spec = AlarmSpec(AlarmKind.FILE_REFUSED, "cut off", "E1.CEV")
            repository.raise_alarm_at(AlarmPlace(motor=motor), spec, now_ns=NOW_NS)
        assert eventually(lambda: all(master.read(one + ALARMED).value for one in (FAN, PUMP)))
        found = [master.read(one + ALARMED) for one in (FAN, PUMP)]
        told_s = time.time()
        assert master.read(PUMP).quality == (0 if stale_after_days > 1 else NOT_TOPICAL)
        assert master.read(FAN).quality == INVALID, "no record of it has been judged"
    assert [one.quality for one in found] == [0, 0]
    assert all(raised_s - 0.001 <= one.time.timestamp() <= told_s for one in found)


def test_an_alarm_is_not_topical_while_the_database_is_silent(repository: Repository) -> None:
    state = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=None)
    silent = state.as_uncertain("the service's database does not answer")
    said = [said_of(POINTS[ALARMED], one.motors["PUMP-A1"], one) for one in (state, silent)]
    assert [QUALITIES[one.quality] for one in said] == [0, NOT_TOPICAL]
    assert [one.read_ns for one in said] == [NOW_NS, NOW_NS]


def test_an_old_condition_is_not_topical(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec104", tmp_path).model_copy(update={"stale_after_days": 0.01})
    with running_gateways(chosen), closing(Master(LOOPBACK, port_of(chosen))) as master:
        master.interrogate()
    assert master.told[PUMP].quality == NOT_TOPICAL


def test_commands_do_nothing_and_say_so(port: int) -> None:
    with closing(Master(LOOPBACK, port)) as master:
        assert master.is_command_refused()


def test_silent_and_garbling_clients_keep_nobody_out(repository: Repository, tmp_path: Path) -> None:
    chosen = settings_of("iec104", tmp_path)
    crowds = 3 * Iec104Settings().max_connections
    with running_gateways(chosen), closing(Master(LOOPBACK, port_of(chosen))) as before, ExitStack() as crowd:
        for number in range(crowds):
            one = crowd.enter_context(socket.create_connection((LOOPBACK, port_of(chosen))))
            if number % 3 == 1:
                one.sendall(b"\x68" + bytes([4 + number]) + os.urandom(number + 4))
            if number % 3 == 2:
                one.sendall(b"\x68\x04\x43\x00\x00\x00")  # TESTFR act
        with closing(Master(LOOPBACK, port_of(chosen))) as master:
            for station in (master, before):
                station.interrogate()
                assert PUMP in station.told


def test_a_gateway_that_is_killed_is_back_with_the_right_values(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec104", tmp_path)

    def fault() -> float | None:
        try:
            with closing(Master(LOOPBACK, port_of(chosen))) as master:
                master.interrogate()
                return master.told[PUMP + 1].value
        except OSError:
            return None

    with running_gateways(chosen) as gateways:
        assert fault() == 0
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        tell(repository, FAULT)
        assert eventually(lambda: fault() == 1)


def test_a_port_that_is_taken_is_told_and_tried_again(repository: Repository, tmp_path: Path) -> None:
    chosen = settings_of("iec104", tmp_path)
    port = port_of(chosen)
    with ExitStack() as running:
        with socket.create_server((LOOPBACK, port)):
            gateways = running.enter_context(started_gateways(chosen))
            wait_until(lambda: f"{LOOPBACK}:{port}: " in (gateways.status()[0].problem or ""), "the port")
            assert "address already in use" in str(gateways.status()[0].problem)
            process = gateways.status()[0].process_id
        wait_until(lambda: gateways.status()[0].problem is None, "the port to be tried again")
        assert gateways.status()[0].process_id == process
        with closing(Master(LOOPBACK, port)) as master:
            master.interrogate()
    assert PUMP in master.told


def test_the_page_has_every_point_and_the_map_is_written(port: int, tmp_path: Path) -> None:
    section = PAGE.read_text(encoding="utf-8").partition("<!-- points: begin -->")[2]
    rows = re.findall(r"^\| (\d+) \| (M_\w+) \| (.*) \|$", section.partition("<!-- points: end -->")[0], re.M)
    said = [(point.kind.name, point.meaning) for point in POINTS]
    likely = [(point.kind.name, point.meaning) for point in LIKELY_PHASES]
    expected = [*said, ("M_SP_TB_1", "The relay answers"), *likely]
    assert rows == [(str(offset), kind, meaning) for offset, (kind, meaning) in enumerate(expected)]
    assert len(KINDS) == len(expected) <= BLOCK
    assert (tmp_path / "iec104-map.csv").read_text(encoding="utf-8").splitlines() == [
        "motor,first address",
        f"FAN-A2,{FAN}",
        f"PUMP-A1,{PUMP}",
    ]


def test_beyond_loopback_somebody_decides_who_may_read() -> None:
    with pytest.raises(ValueError, match="open_to_all"):
        Iec104Settings.model_validate({"bind_address": "10.0.0.1"})
    assert Iec104Settings.model_validate({"bind_address": "10.0.0.1", "open_to_all": True})
