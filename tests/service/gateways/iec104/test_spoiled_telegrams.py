"""Telegrams that are wrong, behind a good STARTDT, end no gateway and keep nobody out."""

import socket
import struct
from contextlib import closing, suppress
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from service.gateways.iec104.points import BLOCK, FIRST
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, tell
from testing.service.gateways import running_gateways
from testing.service.iec104_master import INTERROGATION, Master
from tests.service.gateways.settings import port_of, settings_of
from tests.service.gateways.spoiled_messages import Spoiling, try_spoilings

STATION = struct.pack("<H", 1)
UNITS = (
    bytes([INTERROGATION, 1, 6, 0]) + STATION + b"\x00\x00\x00\x14",
    bytes([101, 1, 6, 0]) + STATION + b"\x00\x00\x00\x05",  # counter interrogation
    bytes([102, 1, 5, 0]) + STATION + b"\xe8\x03\x00",  # read
    bytes([103, 1, 6, 0]) + STATION + b"\x00\x00\x00" + bytes(7),  # clock synchronisation
    bytes([45, 1, 6, 0]) + STATION + b"\xe8\x03\x00\x01",  # single command
    bytes([50, 1, 6, 0]) + STATION + b"\xe8\x03\x00" + struct.pack("<f", 1.0) + b"\x00",  # set point
)
START_DATA_TRANSFER = b"\x68\x04\x07\x00\x00\x00"
ANSWER_S = 0.05


def hold(port: int, telegrams: list[bytes]) -> None:
    """Begin the data transfer, send these as they are, and take what comes."""
    with socket.create_connection((LOOPBACK, port), timeout=10) as link:
        link.sendall(START_DATA_TRANSFER)
        assert link.recv(6) == b"\x68\x04\x0b\x00\x00\x00"
        link.settimeout(ANSWER_S)
        with suppress(OSError):
            for telegram in telegrams:
                link.sendall(telegram)
                link.recv(4096)


def telegram(number: int, unit: bytes) -> bytes:
    """A telegram of information, whose length is right."""
    content = struct.pack("<HH", number << 1, 0) + unit
    return b"\x68" + bytes([len(content) & 0xFF]) + content


def test_telegrams_after_the_start_end_no_gateway(repository: Repository, tmp_path: Path) -> None:
    tell(repository, FAULT)
    chosen = settings_of("iec104", tmp_path)
    port = port_of(chosen)

    def spoiled_unit(spoiling: Spoiling) -> None:
        hold(port, [telegram(number, spoiling.of(number, unit)) for number, unit in enumerate(UNITS)])

    def spoiled_telegram(spoiling: Spoiling) -> None:
        hold(port, [spoiling.of(number, telegram(number, unit)) for number, unit in enumerate(UNITS)])

    @settings(max_examples=40, deadline=None)
    @given(st.lists(st.binary(max_size=249), min_size=1, max_size=8))
    def any_units(units: list[bytes]) -> None:
        hold(port, [telegram(number, unit) for number, unit in enumerate(units)])

    with running_gateways(chosen) as gateways:
        first = gateways.status()[0].process_id
        try_spoilings(len(UNITS), spoiled_unit, examples=60)
        try_spoilings(len(UNITS), spoiled_telegram, examples=40)
        any_units()
        with closing(Master(LOOPBACK, port)) as master:
            master.interrogate()
        status = gateways.status()[0]
        assert (status.process_id, status.restarts) == (first, 0)
    assert master.told[FIRST + BLOCK + 1].value == 1
