"""The server answers the two functions that it documents; all others are illegal, whatever they carry."""

import socket
import struct
from collections.abc import Iterator

import pytest

from service.storage import Repository, connect
from testing.ports import LOOPBACK
from testing.service.database import make_database
from testing.service.gateways import running_gateways
from testing.service.plants import two_motor_plant
from testing.waiting import wait_until
from tests.service.gateways.modbus.telegrams import answer, registers
from tests.service.gateways.settings import port_of, settings_of

READ = (3, 4)
ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
IS_EXCEPTION = 0x80
FUNCTIONS = range(256)

WELL_FORMED = {
    1: ["0000 0008"],
    2: ["0000 0008"],
    5: ["0000 ff00"],
    6: ["0000 0003"],
    8: ["0000 0102", "0001 0000", "0004 0000", "000a 0000"],  # echo, restart, listen only, clear
    15: ["0000 0008 01 ff"],
    16: ["0000 0001 02 0003"],
    20: ["07 06 0004 0001 0002"],
    21: ["09 06 0004 0001 0001 0003"],
    22: ["0000 00f2 0025"],
    23: ["0000 0001 0000 0001 02 0001"],
    24: ["0000"],
    43: ["0e 01 00", "0e 04 00", "0d 00 00"],  # identification, and CANopen
}
"""What makes sense with a function of the standard; the others have nothing behind them."""


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    directory = tmp_path_factory.mktemp("plant")
    Repository(connect(make_database(directory))).sync_plant(two_motor_plant())
    settings = settings_of("modbus", directory)
    with running_gateways(settings):
        yield port_of(settings)


@pytest.fixture
def link(port: int) -> Iterator[socket.socket]:
    with socket.create_connection((LOOPBACK, port), timeout=20) as link:
        yield link


def test_every_function_but_the_two_is_illegal_whatever_it_carries(link: socket.socket) -> None:
    for function in set(FUNCTIONS) - set(READ):
        for behind in ("", "00", "0000 0001", "ff" * 252, *WELL_FORMED.get(function, ())):
            said = answer(link, bytes([function]) + bytes.fromhex(behind))
            # Functions from 128 on have the bit of an exception already.
            assert said == bytes([function | IS_EXCEPTION, ILLEGAL_FUNCTION]), (function, behind)
    for function in READ:
        version, blocks = registers(link, 0, 2, function=function)
        assert (version, blocks) == (1, 2)
    (alive,) = registers(link, 2, 1)
    wait_until(lambda: registers(link, 2, 1) != (alive,), "the counter to move on")


@pytest.mark.parametrize("function", READ)
def test_what_cannot_be_read_is_refused_with_the_reason(link: socket.socket, function: int) -> None:
    for first, count, reason in (
        (0, 0, ILLEGAL_VALUE),
        (0, 126, ILLEGAL_VALUE),
        (0, 65_535, ILLEGAL_VALUE),
        (64_099, 2, ILLEGAL_ADDRESS),
        (65_535, 125, ILLEGAL_ADDRESS),
    ):
        said = answer(link, struct.pack(">BHH", function, first, count))
        assert said == bytes([function | IS_EXCEPTION, reason]), (first, count)
    for cut in (b"", b"\x00", b"\x00\x00\x00"):
        assert answer(link, bytes([function]) + cut) == bytes([function | IS_EXCEPTION, ILLEGAL_VALUE])
    assert len(registers(link, 63_975, 125, function=function)) == 125


def test_every_unit_reads_the_same(link: socket.socket) -> None:
    request = struct.pack(">BHH", 4, 0, 2)
    assert {answer(link, request, unit=unit) for unit in range(256)} == {bytes.fromhex("0404 0001 0002")}
