"""HistoryRead with bounds: the values at both times that are named, or those next to them outside."""

from datetime import datetime
from itertools import chain
from pathlib import Path
from typing import Any

from asyncua import Client, ua

from service.configuration.settings import Settings
from service.storage import Repository
from testing.service.plants import fault
from tests.service.gateways.opcua.clients import looking, node
from tests.service.gateways.opcua.test_history_reads import FIRST, LOAD, SECOND, answer, details_of, keep

BOUNDS: dict[tuple[int | None, int | None, int], tuple[list[int | str], list[int | str]]] = {
    (0, 5, 0): ([0, 2, 3, 5], [0, 2, 3]),
    (1, 4, 0): ([0, 2, 3, 5], [2, 3]),
    (5, 0, 0): ([5, 3, 2, 0], [5, 3, 2]),
    (4, 1, 0): ([5, 3, 2, 0], [3, 2]),
    (-1, 5, 0): (["no bound at -1", 0, 2, 3, 5], [0, 2, 3]),
    (1, 7, 0): ([0, 2, 3, 5, 6, "no bound at 7"], [2, 3, 5, 6]),
    (0, 5, 3): ([0, 2, 3], [0, 2, 3]),
    (1, 4, 3): ([0, 2, 3], [2, 3]),
    (5, 0, 3): ([5, 3, 2], [5, 3, 2]),
    (4, 1, 3): ([5, 3, 2], [3, 2]),
    (-1, 5, 3): (["no bound at -1", 0, 2], [0, 2, 3]),
    (1, 7, 3): ([0, 2, 3], [2, 3, 5]),
    (0, None, 3): ([0, 2, 3], [0, 2, 3]),
    (0, None, 6): ([0, 2, 3, 5, 6, "no bound at 7"], [0, 2, 3, 5, 6]),
    (None, 6, 3): ([6, 5, 3], [6, 5, 3]),
    (None, 6, 6): ([6, 5, 3, 2, 0, "no bound at -1"], [6, 5, 3, 2, 0]),
    (2, 2, 0): ([2], [2]),
    (4, 4, 0): ([3, 5], []),
    (8, 9, 0): ([6, "no bound at 9"], []),
}
"""Table 1 of OPC 10000-11 and more: by start, end and most, what is told with bounds and without them.

Values of seconds 0, 2, 3, 5 and 6 are kept. Where no end is named, its bound is a second beyond the last one.
"""


def told_in(result: Any) -> list[int | str]:
    """The seconds of the values of an answer."""

    def told(one: Any) -> int | str:
        second: int = round((one.SourceTimestamp - FIRST) / SECOND)
        if one.StatusCode.value == ua.StatusCodes.BadBoundNotFound:
            assert one.Value.Value is None
            return f"no bound at {second}"
        assert one.StatusCode.value == ua.StatusCodes.Good
        return second

    return [told(one) for one in result.HistoryData.DataValues]


def test_bounds_are_told_where_they_are_asked_for(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.01)] * 5, [0, 2, 3, 5, 6])

    def at(second: int | None) -> datetime | None:
        return None if second is None else FIRST + second * SECOND

    async def ask(client: Client) -> dict[object, list[int | str]]:
        load = node(client, LOAD)
        return {
            (*asked, bounds): told_in(
                await load.history_read(details_of(at(asked[0]), at(asked[1]), asked[2], bounds=bounds))
            )
            for asked in BOUNDS
            for bounds in (True, False)
        }

    expected = {(*asked, True): told for asked, (told, _) in BOUNDS.items()}
    expected |= {(*asked, False): told for asked, (_, told) in BOUNDS.items()}
    assert looking(settings, ask) == expected


def test_bounds_count_among_the_values_of_an_answer(
    repository: Repository, tmp_path: Path, settings: Settings
) -> None:
    keep(repository, tmp_path, [fault(0.01)] * 5, [0, 2, 3, 5, 6])
    oldest_first = ["no bound at -1", 0, 2, 3, 5, 6, "no bound at 7"]
    before, after = FIRST - SECOND, FIRST + 7 * SECOND

    async def pages(client: Client, details: object) -> list[list[int | str]]:
        told: list[list[int | str]] = []
        continuation = None
        while not told or continuation is not None:
            result = await node(client, LOAD).history_read(details, continuation)
            told.append(told_in(result))
            continuation = result.ContinuationPoint
        return told

    async def ask(client: Client) -> None:
        for start, end, expected in ((before, after, oldest_first), (after, before, oldest_first[::-1])):
            for most in (1, 2, 3, 6, 7):
                told = await pages(client, details_of(start, end, most, bounds=True))
                assert list(chain(*told)) == expected, most
                assert {len(one) for one in told[:-1]} <= {most}

    looking(settings, ask)


def test_a_motor_without_records_has_no_bounds(settings: Settings) -> None:
    found = answer(settings, LOAD, details_of(FIRST, FIRST + SECOND, bounds=True))
    assert found.StatusCode.value == ua.StatusCodes.GoodNoData
    assert told_in(found) == ["no bound at 0", "no bound at 1"]
