"""A client of open61850 is told of changes by buffered reports, also of those that came while it was away."""

from dataclasses import replace
from datetime import UTC, datetime

from open61850 import mms as open_mms

from mms import Client
from service.gateways.iec61850.description import CONFIGURATION_REVISION
from service.storage import Repository
from service.storage.states import LinkState
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, UNKNOWN, tell
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import wait_until
from tests.service.gateways.iec61850.reports import reports_of
from tests.service.gateways.iec61850.test_iec61850 import MEASURED, PUMP, port

__all__ = ["port"]  # a fixture

LEVEL, RELAY = "GGIO1.AnIn1", "LPHD1.PhyHealth"
CHANGED = open_mms.ReasonCode(data_change=True)
QUALITY_CHANGED = open_mms.ReasonCode(quality_change=True)
BOTH_CHANGED = open_mms.ReasonCode(data_change=True, quality_change=True)
GOOD, INVALID, QUESTIONABLE = b"\x00\x00", b"\x40\x00", b"\xc0\x00"
LATER_NS = NOW_NS + 3600 * SECOND_NS
NOW, LATER = (datetime.fromtimestamp(time_ns // SECOND_NS, UTC) for time_ns in (NOW_NS, LATER_NS))


def tell_level(repository: Repository, port: int, level: float) -> None:
    """Have a level of the fault told, and wait until the server has it."""
    tell(repository, replace(HEALTHY, mu_f=level))
    with Client.connect(LOOPBACK, port) as client:

        def is_there() -> bool:
            found = client.read(f"{PUMP}/{LEVEL}.mag.f", MEASURED)
            return isinstance(found, float) and abs(found - 100 * level) < 1e-4

        wait_until(is_there, f"the level {level}")


def tell_link(repository: Repository) -> None:
    """Have another change told: once its report has come, none of the change before is under way any more."""
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, now_ns=LATER_NS, reason="no answer")


def test_one_change_is_told_with_values_quality_time_and_why(repository: Repository, port: int) -> None:
    tell_level(repository, port, 0.001)
    with reports_of(port, PUMP) as reports:
        tell(repository, replace(FAULT, as_of_ns=LATER_NS), now_ns=LATER_NS)
        told = [reports.next()]
        tell_link(repository)
        told += reports.until(RELAY)
    found = {name: value for one in told for name, value in one.values.items()}
    assert found == {
        "ZMOT1.EEHealth": (3, GOOD, LATER),
        "GAPC1.Str": (True, 0, False, 0, True, 0, False, 0, GOOD, LATER),
        "GAPC1.Op": (True, False, True, False, GOOD, LATER),
        "GGIO1.IntIn1": (1, GOOD, LATER),
        "GGIO1.AnIn1": ((1.21,), GOOD, LATER),
        "GGIO1.AnIn2": ((0.9,), GOOD, LATER),
        "GGIO1.AnIn3": ((2.25,), GOOD, LATER),
        "GGIO1.AnIn6": ((1.2,), GOOD, LATER),
    }
    assert len(told) == 1
    for one in told:
        assert one.values.items() <= found.items(), "no report has half a change of an object"
        assert {member.reason for member in one.members.values()} == {CHANGED}
        assert one.revision == int(CONFIGURATION_REVISION)


def test_a_change_of_one_figure_is_one_report_of_it(repository: Repository, port: int) -> None:
    tell_level(repository, port, 0.001)
    with reports_of(port, PUMP) as reports:
        tell_level(repository, port, 0.002)
        tell_link(repository)
        told = reports.until(RELAY)
    assert [one.values for one in told] == [{LEVEL: ((0.2,), GOOD, NOW)}]
    assert told[0].members[LEVEL].reason == CHANGED


def test_a_quality_that_changes_is_told_as_such(repository: Repository, port: int) -> None:
    tell_level(repository, port, 0.001)
    with reports_of(port, PUMP) as reports:
        tell(repository, replace(UNKNOWN, as_of_ns=LATER_NS), now_ns=LATER_NS)
        told = [reports.next()]
        tell_link(repository)
        told += reports.until(RELAY)
    found = {name: member for one in told for name, member in one.members.items()}
    health, on, level = found["ZMOT1.EEHealth"], found["GAPC1.Op"], found[LEVEL]
    assert (health.value, health.reason) == ((2, QUESTIONABLE, LATER), BOTH_CHANGED)
    assert (on.value, on.reason) == ((False, False, False, False, QUESTIONABLE, LATER), QUALITY_CHANGED)
    assert (level.value, level.reason) == (((None,), INVALID, LATER), BOTH_CHANGED)


def test_a_client_that_was_away_is_told_what_came_meanwhile_and_nothing_twice(
    repository: Repository, port: int
) -> None:
    tell_level(repository, port, 0.001)
    with reports_of(port, PUMP) as reports:
        tell_level(repository, port, 0.002)
        seen = reports.next()
    for level in (0.003, 0.004):
        tell_level(repository, port, level)
    with reports_of(port, PUMP, after=seen.entry_id) as reports:
        missed = [reports.next(), reports.next()]
        tell_level(repository, port, 0.005)
        live = reports.next()
    told = [seen, *missed, live]
    assert [one.values[LEVEL] for one in told] == [((one,), GOOD, NOW) for one in (0.2, 0.3, 0.4, 0.5)]
    assert [one.members[LEVEL].reason for one in told] == [CHANGED] * 4
    assert all(set(one.members) == {LEVEL} and not one.overflow for one in [*missed, live])
