"""HistoryRead: values of a motor's records in both orders, in answers of bounded size, and refusals."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua
from sqlalchemy import insert, inspect, select
from sqlalchemy.orm import Session

from core.diagnosis.verdict import Diagnosis
from service.configuration.settings import Settings, sqlite_url
from service.gateways.opcua.history import MOST, MOST_OF_ALL, utc
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.models import DiagnosisRow, JobRow
from testing.service.conditions import FAULT, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.gateways import running_gateways
from testing.service.job_runner import register_runner
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable
from tests.service.gateways.opcua.clients import PUMP, looking, node, value
from tests.service.gateways.settings import settings_of

LEVEL, LOAD = f"{PUMP}/FaultLevel", f"{PUMP}/Load"
"""The level is the condition's; the load is each record's own, so most tests look at that."""
FIRST = datetime.fromtimestamp(NOW_NS // SECOND_NS, UTC)
SECOND = timedelta(seconds=1)
LONG_AGO, FAR = datetime(1960, 1, 1, tzinfo=UTC), datetime(9999, 12, 31, 23, 59, 59, tzinfo=UTC)


def keep(
    repository: Repository, tmp_path: Path, diagnoses: Sequence[Diagnosis], times_s: Sequence[int] = ()
) -> None:
    """Have records of PUMP-A1 diagnosed so, each with its level as its load: one a second, or at times."""
    register_runner(repository)
    store = FolderStore(tmp_path / "recordings")
    for number, diagnosis in enumerate(diagnoses):
        at_s = times_s[number] if times_s else number
        told = replace(diagnosis, load_level=diagnosis.mu_f)
        add_diagnosed(repository, store, told, NOW_NS + at_s * SECOND_NS, name=f"E{number}")


def repeat(tmp_path: Path, times: int) -> None:
    """Have the database keep the one diagnosis that it has so often more, each of a second later."""
    with Session(connect(sqlite_url(tmp_path))) as session, session.begin():
        job, diagnosis = (_values(session.scalars(select(row)).one()) for row in (JobRow, DiagnosisRow))
        numbers = range(1, times + 1)
        session.execute(insert(JobRow), [job | {"id": f"job {number}"} for number in numbers])
        more = [
            {"id": f"diagnosis {number}", "job_id": f"job {number}", "load_level": number / 10**5}
            | {"recorded_ns": NOW_NS + number * SECOND_NS}
            for number in numbers
        ]
        session.execute(insert(DiagnosisRow), [diagnosis | one for one in more])


def _values(row: object) -> dict[str, Any]:
    return {column.key: getattr(row, column.key) for column in inspect(type(row)).mapper.column_attrs}


def details_of(
    start: datetime | None,
    end: datetime | None,
    most: int = 0,
    *,
    modified: bool = False,
    bounds: bool = False,
) -> ua.ReadRawModifiedDetails:
    nobody = ua.get_win_epoch()
    return ua.ReadRawModifiedDetails(
        IsReadModified=modified,
        StartTime=start or nobody,
        EndTime=end or nobody,
        NumValuesPerNode=most,
        ReturnBounds=bounds,
    )


def answer(settings: Settings, path: str, details: object, continuation: bytes | None = None) -> Any:
    """One answer of the server."""

    async def ask(client: Client) -> Any:
        return await node(client, path).history_read(details, continuation)

    return looking(settings, ask)


def answers(settings: Settings, path: str, details: object) -> list[list[float]]:
    """The values of all answers that a client is given who asks on as long as there is more."""

    async def ask(client: Client) -> list[list[float]]:
        found: list[list[float]] = []
        continuation = None
        while not found or continuation is not None:
            result = await node(client, path).history_read(details, continuation)
            result.StatusCode.check()
            found.append([one.Value.Value for one in result.HistoryData.DataValues])
            continuation = result.ContinuationPoint
        return found

    return looking(settings, lambda client: asyncio.wait_for(ask(client), 60))  # type: ignore[no-any-return] # of any client


def values(settings: Settings, start: datetime | None, end: datetime | None, most: int = 0) -> list[float]:
    """The loads of the first answer."""
    (first, *_) = answers(settings, LOAD, details_of(start, end, most))
    return first


def refusal(settings: Settings, ask: Callable[[Client], Awaitable[Any]]) -> str:
    """The status code with which a client is refused."""
    with pytest.raises(ua.UaStatusCodeError) as refused:
        looking(settings, ask)
    return type(refused.value).__name__


def told(settings: Settings, path: str) -> list[tuple[float | None, int, datetime]]:
    """All values that a variable told, with status and time."""
    found = answer(settings, path, details_of(LONG_AGO, FAR)).HistoryData.DataValues
    return [(one.Value.Value, one.StatusCode.value, one.SourceTimestamp) for one in found]


def test_loads_are_those_of_their_records_with_times(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    doubtful = replace(undiagnosable(), mu_f=0.03)
    keep(repository, tmp_path, [fault(0.01), undiagnosable(), doubtful, fault(0.02)])

    times = [FIRST + second * SECOND for second in range(4)]
    good, none = ua.StatusCodes.Good, ua.StatusCodes.BadNoData
    found = told(settings, LOAD)
    assert found == list(zip([0.01, None, 0.03, 0.02], [good, none, none, good], times, strict=True))


def test_levels_are_those_of_the_condition_as_the_variable_told_them(
    repository: Repository, tmp_path: Path
) -> None:
    register_runner(repository)
    store = FolderStore(tmp_path / "recordings")
    seen = [observation(hour) for hour in (-2, -1)]
    for number, one in enumerate(seen):  # each record by itself shows 5.1 %
        add_diagnosed(repository, store, fault(), one.time_ns, name=f"E{number}", observed=one)
    tell(repository, replace(FAULT, as_of_ns=seen[-1].time_ns))

    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    with running_gateways(chosen):
        history, now = told(chosen, LEVEL), value(chosen, LEVEL)

    assert history == [(FAULT.mu_f, ua.StatusCodes.Good, utc(one.time_ns)) for one in seen]
    assert (now.Value.Value, now.StatusCode.value, now.SourceTimestamp) == history[-1]


def test_more_than_a_thousand_values_come_in_answers_of_a_thousand(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.0)])
    repeat(tmp_path, MOST + 2)
    levels = [number / 10**5 for number in range(MOST + 3)]
    oldest_first = answers(settings, LOAD, details_of(FIRST, FAR))
    assert [len(one) for one in oldest_first] == [MOST, 3]
    assert list(chain(*oldest_first)) == levels
    newest_first = answers(settings, LOAD, details_of(FAR, LONG_AGO))
    assert [len(one) for one in newest_first] == [MOST, 3]
    assert list(chain(*newest_first)) == levels[::-1]
    assert len(values(settings, FIRST, FAR, 5 * MOST)) == MOST


def test_many_nodes_share_the_values_of_an_answer(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.0)])
    repeat(tmp_path, 2 * MOST_OF_ALL // 50)
    nodes = 50

    async def ask(client: Client) -> list[Any]:
        load = node(client, LOAD)
        asked = ua.HistoryReadParameters(
            HistoryReadDetails=details_of(FIRST, FAR),
            ReleaseContinuationPoints=False,
            NodesToRead=[ua.HistoryReadValueId(NodeId=load.nodeid)] * nodes,
        )
        first = list(await client.uaclient.history_read(asked))
        return [*first, await load.history_read(details_of(FIRST, FAR), first[-1].ContinuationPoint)]

    *shares, rest = looking(settings, ask)
    assert {one.StatusCode.name for one in (*shares, rest)} == {"Good"}
    told = [[one.Value.Value for one in share.HistoryData.DataValues] for share in shares]
    assert [len(one) for one in told] == [MOST_OF_ALL // nodes] * nodes
    later = [one.Value.Value for one in rest.HistoryData.DataValues]
    assert told[-1] + later == [number / 10**5 for number in range(2 * MOST_OF_ALL // nodes + 1)]


def test_the_newest_come_first_where_the_start_is_later_than_the_end_or_not_named(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(level / 100) for level in range(1, 6)])
    newest_first = [0.05, 0.04, 0.03, 0.02, 0.01]
    last = FIRST + 4 * SECOND
    assert values(settings, last, LONG_AGO) == newest_first
    assert values(settings, last - SECOND, FIRST + SECOND) == [0.04, 0.03]
    assert values(settings, None, last, 2) == [0.05, 0.04]
    assert values(settings, None, last - SECOND, 2) == [0.04, 0.03]
    assert values(settings, FIRST, None, 2) == [0.01, 0.02]
    assert answers(settings, LOAD, details_of(None, last, 2)) == [[0.05, 0.04], [0.03, 0.02], [0.01]]
    assert answers(settings, LOAD, details_of(FIRST, FAR, 2)) == [[0.01, 0.02], [0.03, 0.04], [0.05]]


def test_a_window_has_what_is_in_it_alone(repository: Repository, tmp_path: Path, settings: Settings) -> None:
    keep(repository, tmp_path, [fault(level / 100) for level in range(1, 6)])
    assert values(settings, FIRST + SECOND, FIRST + 3 * SECOND) == [0.02, 0.03]
    assert values(settings, FIRST + 0.5 * SECOND, FIRST + 2.5 * SECOND) == [0.02, 0.03]
    assert values(settings, FIRST + SECOND, FIRST + SECOND) == [0.02]
    assert values(settings, LONG_AGO, FIRST + SECOND) == [0.01]
    assert values(settings, FIRST + 4 * SECOND, FAR) == [0.05]
    nothing = answer(settings, LOAD, details_of(FIRST + 5 * SECOND, FAR))
    assert nothing.StatusCode.value == ua.StatusCodes.GoodNoData
    assert nothing.HistoryData.DataValues == []


def test_each_of_several_records_of_one_time_is_told_once(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    levels = [0.01, 0.02, 0.03, 0.04, 0.05]
    keep(repository, tmp_path, [fault(level) for level in levels], [0, 1, 1, 1, 2])
    for start, end in ((FIRST, FAR), (FAR, LONG_AGO)):
        for most in (1, 2, 3, 4):
            told = answers(settings, LOAD, details_of(start, end, most))
            assert sorted(chain(*told)) == levels, (start, most)
            assert {len(one) for one in told[:-1]} == {most}


def test_what_has_no_history_is_refused(settings: Settings) -> None:
    raw = details_of(FIRST, FAR)

    def read(path: str, details: object = raw) -> Callable[[Client], Awaitable[None]]:
        async def ask(client: Client) -> None:
            (await node(client, path).history_read(details)).StatusCode.check()

        return ask

    async def events(client: Client) -> None:
        await node(client, PUMP).read_event_history()

    unsupported = "BadHistoryOperationUnsupported"
    assert refusal(settings, read("motor/NOBODY/FaultLevel")) == "BadNodeIdUnknown"
    assert refusal(settings, read(f"{PUMP}/State")) == unsupported
    assert refusal(settings, read(PUMP)) == unsupported
    assert refusal(settings, read("relay/A1_SEL710/Link")) == unsupported
    assert refusal(settings, read(LOAD, details_of(FIRST, FAR, modified=True))) == unsupported
    assert refusal(settings, read(LOAD, ua.ReadAtTimeDetails(ReqTimes=[FIRST]))) == unsupported
    assert refusal(settings, events) == unsupported


def test_a_node_that_is_refused_leaves_others_their_answers(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.01)])
    paths = (LEVEL, f"{PUMP}/State", "motor/NOBODY/Load", LOAD)

    async def ask(client: Client) -> list[Any]:
        asked = [ua.HistoryReadValueId(NodeId=node(client, path).nodeid, IndexRange="") for path in paths]
        request = ua.HistoryReadParameters(
            HistoryReadDetails=details_of(FIRST, FAR), ReleaseContinuationPoints=False, NodesToRead=asked
        )
        return list(await client.uaclient.history_read(request))

    found = looking(settings, ask)
    assert [one.StatusCode.name for one in found] == [
        "GoodNoData",
        "BadHistoryOperationUnsupported",
        "BadNodeIdUnknown",
        "Good",
    ]
    assert [one.Value.Value for one in found[-1].HistoryData.DataValues] == [0.01]


def test_a_motor_without_records_has_no_history(settings: Settings) -> None:
    for details in (details_of(FIRST, FAR), details_of(FAR, FIRST), details_of(None, FAR, 5)):
        found = answer(settings, LOAD, details)
        assert found.StatusCode.value == ua.StatusCodes.GoodNoData
        assert (found.HistoryData.DataValues, found.ContinuationPoint) == ([], None)


def test_a_continuation_point_is_the_servers_own_or_refused(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.01), fault(0.02)])
    details = details_of(FIRST, FAR, 1)
    assert answer(settings, LOAD, details).ContinuationPoint
    refused = answer(settings, LOAD, details, b"not the server's")
    assert refused.StatusCode.value == ua.StatusCodes.BadContinuationPointInvalid


def test_the_server_says_what_its_histories_are_good_for(settings: Settings) -> None:
    async def ask(client: Client) -> dict[str, object]:
        capabilities = client.get_node(ua.NodeId(ua.ObjectIds.HistoryServerCapabilities))
        return {
            (await one.read_browse_name()).Name: await one.read_value()
            for one in await capabilities.get_properties()
        }

    told = looking(settings, ask)
    assert told.pop("MaxReturnDataValues") == MOST
    assert told.pop("MaxReturnEventValues") == 0
    assert [name for name, is_so in told.items() if is_so] == ["AccessHistoryDataCapability"]
    assert set(told.values()) == {True, False}
