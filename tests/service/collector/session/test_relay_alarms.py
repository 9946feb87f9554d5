"""The alarms of one relay: raised once each, and not without end."""

from service.collector.session.relay_alarms import AND_MORE, RelayAlarms
from service.collector.session.session_policy import SESSION_POLICY
from service.storage.states import AlarmKind
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME


def test_a_million_bad_names_are_a_thousand_alarms_and_one(bench: Bench) -> None:
    alarms = RelayAlarms(NAME, bench.repository, most=3)
    for number in range(50):
        alarms.raise_alarm(AlarmKind.FILE_REFUSED, f"bad {number}", "outside")
    subjects = ["bad 0", "bad 1", "bad 2", AND_MORE]
    assert bench.alarms() == {AlarmKind.FILE_REFUSED: subjects}
    alarms = RelayAlarms(NAME, bench.repository)
    alarms.keep(AlarmKind.FILE_REFUSED, {"bad 1"})
    assert bench.alarms() == {AlarmKind.FILE_REFUSED: ["bad 1", AND_MORE]}
    alarms.keep(AlarmKind.FILE_REFUSED, ())
    assert bench.alarms() == {}
    assert SESSION_POLICY.most_alarms == 1000
