"""A client gets the time stamps that it asks for, and no others."""

from pathlib import Path

import pytest
from asyncua import Client, ua

from service.configuration.settings import Settings
from service.storage import Repository
from tests.service.gateways.opcua.clients import PUMP, address_of, node
from tests.service.gateways.opcua.test_sessions import refused, served

CHOICES = ua.TimestampsToReturn


def test_reads_have_the_stamps_that_are_asked_for(repository: Repository, tmp_path: Path) -> None:
    async def work(settings: Settings) -> None:
        async with Client(address_of(settings)) as client:
            asked = ua.ReadParameters(
                NodesToRead=[ua.ReadValueId(node(client, f"{PUMP}/State").nodeid, ua.AttributeIds.Value)]
            )
            for wanted, (has_source, has_server) in {
                CHOICES.Source: (True, False),
                CHOICES.Server: (False, True),
                CHOICES.Both: (True, True),
                CHOICES.Neither: (False, False),
            }.items():
                asked.TimestampsToReturn = wanted
                [value] = await client.uaclient.read(asked)
                assert value.Value.Value is not None
                assert (value.SourceTimestamp is not None) is has_source, wanted
                assert (value.ServerTimestamp is not None) is has_server, wanted
            asked.TimestampsToReturn = CHOICES.Invalid
            assert await refused(client.uaclient.read(asked)) == "BadTimestampsToReturnInvalid"

    served(repository, tmp_path, work, is_open=True)


@pytest.mark.parametrize("wanted", [CHOICES.Neither, CHOICES.Invalid])
def test_a_history_has_times(repository: Repository, tmp_path: Path, wanted: ua.TimestampsToReturn) -> None:
    async def work(settings: Settings) -> None:
        async with Client(address_of(settings)) as client:
            asked = ua.HistoryReadParameters(
                HistoryReadDetails=ua.ReadRawModifiedDetails(),
                TimestampsToReturn=wanted,
                NodesToRead=[ua.HistoryReadValueId(node(client, f"{PUMP}/State").nodeid)],
            )
            assert await refused(client.uaclient.history_read(asked)) == "BadTimestampsToReturnInvalid"

    served(repository, tmp_path, work, is_open=True)
