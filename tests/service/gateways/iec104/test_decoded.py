"""Wireshark reads what the IEC 60870-5-104 gateway sends as it was meant."""

import json
import os
import shutil
import socket
import struct
import subprocess
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.gateways.iec104.gateway import KINDS
from service.gateways.iec104.points import RELAY_ANSWERS
from service.gateways.iec104.server import StationServer
from service.gateways.iec104.telegrams import single_point
from service.storage import Repository
from service.storage.states import LinkState
from testing.not_installed import not_installed
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.iec104_master import (
    FLOAT,
    INTERROGATED,
    PLAIN_FLOAT,
    PLAIN_SINGLE,
    PLAIN_WHOLE,
    REQUESTED,
    SINGLE,
    SPONTANEOUS,
    WHOLE,
    Master,
)
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS
from tests.service.gateways.iec104.test_iec104 import FAN, PUMP
from tests.service.gateways.settings import port_of, settings_of

STATION = 7
OLD_NS = NOW_NS - 4000 * NANOSECONDS_PER_DAY
READ = (PUMP, PUMP + 2, PUMP + 9, FAN, FAN + RELAY_ANSWERS)
CHANGED_NS = NOW_NS + 1_234 * SECOND_NS // 1000
STATION_PORT, MASTER_PORT = 2404, 50_000
"""In the capture: Wireshark knows the protocol by its port."""

VALUES = {
    **dict.fromkeys((SINGLE, PLAIN_SINGLE), "siq.spi"),
    **dict.fromkeys((WHOLE, PLAIN_WHOLE), "scalval"),
    **dict.fromkeys((FLOAT, PLAIN_FLOAT), "float"),
}
"""Types of telegrams that tell something, and what Wireshark calls the value."""

NEUTRAL = datetime(2000, 1, 1, tzinfo=UTC)
"""What stands for a time that is not known, beside the bit that says so."""

RAW_IP = 101
"""Packets of the capture begin with the header of IP."""


@dataclass(frozen=True, slots=True)
class Part:
    """Octets on their way."""

    from_station: bool
    content: bytes


@dataclass(frozen=True, slots=True)
class Decoded:
    """An information object as Wireshark reads it, with type, cause and station of its telegram.

    time: None where the type has none.
    """

    kind: int
    cause: int
    station: int
    value: float
    is_invalid: bool
    is_not_topical: bool
    time: datetime | None = None
    is_time_invalid: bool = False


@contextmanager
def tapped(server_port: int) -> Iterator[tuple[int, list[Part]]]:
    """Yield a port that leads to the server for one client, and what passes there."""
    passed: list[Part] = []
    with socket.create_server((LOOPBACK, 0)) as listening:
        carrier = threading.Thread(target=_carry, args=(listening, server_port, passed), daemon=True)
        carrier.start()
        yield listening.getsockname()[1], passed
        carrier.join(20)


def _carry(listening: socket.socket, server_port: int, passed: list[Part]) -> None:
    client, _ = listening.accept()
    with client, socket.create_connection((LOOPBACK, server_port)) as server:
        back = threading.Thread(target=_pass_on, args=(server, client, passed), kwargs={"from_station": True})
        back.start()
        _pass_on(client, server, passed, from_station=False)
        with suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)
        back.join(20)


def _pass_on(source: socket.socket, target: socket.socket, passed: list[Part], *, from_station: bool) -> None:
    with suppress(OSError):
        while content := source.recv(4096):
            passed.append(Part(from_station, content))
            target.sendall(content)


def capture(passed: Sequence[Part]) -> bytes:
    """What passed as a pcap file of TCP segments."""
    file = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65_535, RAW_IP)
    sent = {True: 1, False: 1}
    for number, part in enumerate(passed):
        station, master = (STATION_PORT, bytes([10, 0, 0, 1])), (MASTER_PORT, bytes([10, 0, 0, 2]))
        source, target = (station, master) if part.from_station else (master, station)
        numbers = sent[part.from_station], sent[not part.from_station]
        segment = struct.pack(">HHIIBBHHH", source[0], target[0], *numbers, 0x50, 0x18, 65_535, 0, 0)
        segment += part.content
        head = struct.pack(
            ">BBHHHBBH4s4s", 0x45, 0, 20 + len(segment), number, 0, 64, 6, 0, source[1], target[1]
        )
        size = len(head) + len(segment)
        file += struct.pack("<IIII", number, 0, size, size) + head + segment
        sent[part.from_station] += len(part.content)
    return file


def tshark(file: Path, *arguments: str) -> str:
    """What Wireshark's command line says of a capture."""
    if shutil.which("tshark") is None:
        not_installed("no tshark: apt-get install --no-install-recommends tshark")
    done = subprocess.run(
        ["tshark", "-n", "-r", str(file), *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
        env={**os.environ, "TZ": "UTC"},
    )
    return done.stdout


def decoded(file: Path) -> list[tuple[int, Decoded]]:
    """The information objects that the station sent, each with its address, in their order."""
    chosen = f"tcp.srcport == {STATION_PORT} && iec60870_asdu"
    frames = json.loads(tshark(file, "-T", "json", "--no-duplicate-keys", "-Y", chosen))
    found: list[tuple[int, Decoded]] = []
    for frame in frames:
        units = frame["_source"]["layers"]["iec60870_asdu"]
        for unit in units if isinstance(units, list) else [units]:
            if int(unit["iec60870_asdu.typeid"]) not in VALUES:
                continue
            objects = [one for key, one in unit.items() if key.startswith("IOA")]
            assert len(objects) == int(unit["iec60870_asdu.numix"])
            found += [_object(unit, dict(_leaves(one))) for one in objects]
    return found


def _leaves(tree: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from _leaves(value)
        else:
            yield name.removeprefix("iec60870_asdu."), value


def _object(unit: Mapping[str, str], leaves: Mapping[str, str]) -> tuple[int, Decoded]:
    head = {name: int(unit[f"iec60870_asdu.{name}"]) for name in ("typeid", "causetx", "addr")}
    kind = head["typeid"]
    value = leaves[VALUES[kind]]
    quality = "siq" if kind in (SINGLE, PLAIN_SINGLE) else "qds"
    return int(leaves["ioa"]), Decoded(
        kind,
        head["causetx"],
        head["addr"],
        value=float(value),
        is_invalid=bool(int(leaves[f"{quality}.iv"])),
        is_not_topical=bool(int(leaves[f"{quality}.nt"])),
        time=_time(leaves),
        is_time_invalid=bool(int(leaves.get("cp56time.iv", "0"))),
    )


def _time(leaves: Mapping[str, str]) -> datetime | None:
    if "cp56time.year" not in leaves:
        return None
    year, month, day, hour, minute, milliseconds = (
        int(leaves[f"cp56time.{name}"]) for name in ("year", "month", "day", "hour", "min", "ms")
    )
    begun = datetime((1900 if year >= 70 else 2000) + year, month, day, hour, minute, tzinfo=UTC)
    return begun + timedelta(milliseconds=milliseconds)


def at(time_ns: int) -> datetime:
    return datetime.fromtimestamp(time_ns / SECOND_NS, UTC)


@pytest.fixture
def passed(repository: Repository, tmp_path: Path) -> list[Part]:
    """What passes while a master asks for everything, is told that a relay does not answer, and reads."""
    tell(repository, FAULT)
    tell(repository, replace(HEALTHY, motor="FAN-A2", as_of_ns=OLD_NS))
    chosen = settings_of("iec104", tmp_path, common_address=STATION)
    with (
        running_gateways(chosen),
        tapped(port_of(chosen)) as (port, passed),
        closing(Master(LOOPBACK, port)) as master,
    ):
        master.interrogate(STATION)
        set_link_state(repository, "A1_SEL710", LinkState.DOWN, now_ns=CHANGED_NS, reason="no answer")
        master.next_change()
        for place in READ:
            master.read(place, STATION)
    return passed


def test_wireshark_reads_values_qualities_and_times_as_they_were_told(
    passed: list[Part], tmp_path: Path
) -> None:
    file = tmp_path / "session.pcap"
    file.write_bytes(capture(passed))
    told = decoded(file)
    assert tshark(file, "-Y", "_ws.malformed || _ws.expert") == ""
    interrogated = {place: one for place, one in told if one.cause == INTERROGATED}
    kinds = {"M_SP_TB_1": PLAIN_SINGLE, "M_ME_TE_1": PLAIN_WHOLE, "M_ME_TF_1": PLAIN_FLOAT}
    expected = {
        block + offset: kinds[kind.name] for block in (FAN, PUMP) for offset, kind in enumerate(KINDS)
    }
    assert {place: one.kind for place, one in interrogated.items()} == expected
    assert {one.station for _, one in told} == {STATION}

    good = Decoded(PLAIN_SINGLE, INTERROGATED, STATION, value=1, is_invalid=False, is_not_topical=False)
    assert [interrogated[PUMP], interrogated[PUMP + 1]] == [good, good]
    level = interrogated[PUMP + 2]
    assert level == replace(good, kind=PLAIN_FLOAT, value=level.value)
    assert level.value == pytest.approx(1.21)
    assert [interrogated[PUMP + offset].value for offset in (3, 4, 5)] == pytest.approx([0.9, 2.25, 1.2])
    assert interrogated[PUMP + 7] == replace(good, kind=PLAIN_FLOAT, value=0, is_invalid=True), "the load"
    assert interrogated[PUMP + 8] == replace(good, kind=PLAIN_WHOLE, value=1), "the kind: shorted turns"
    assert interrogated[PUMP + 9] == replace(good, kind=PLAIN_WHOLE, value=2), "the phase: b"

    old = replace(good, value=0, is_not_topical=True)
    assert [interrogated[FAN], interrogated[FAN + 1]] == [old, old]
    assert interrogated[FAN + RELAY_ANSWERS].is_invalid

    (change,) = [(place, one) for place, one in told if one.cause == SPONTANEOUS]
    tagged = replace(good, kind=SINGLE, cause=SPONTANEOUS, value=0, time=at(CHANGED_NS))
    assert change == (PUMP + RELAY_ANSWERS, tagged)

    read = [(place, one) for place, one in told if one.cause == REQUESTED]
    tagged = replace(tagged, cause=REQUESTED, value=1, time=at(NOW_NS))
    assert read == [
        (PUMP, tagged),
        (PUMP + 2, replace(tagged, kind=FLOAT, value=level.value)),
        (PUMP + 9, replace(tagged, kind=WHOLE, value=2)),
        (FAN, replace(old, kind=SINGLE, cause=REQUESTED, time=at(OLD_NS))),
        (FAN + RELAY_ANSWERS, replace(tagged, value=0, is_invalid=True, time=NEUTRAL, is_time_invalid=True)),
    ]


def test_wireshark_reads_times_that_are_not_known_or_do_not_fit_as_invalid(tmp_path: Path) -> None:
    end_ns = int(datetime(2070, 1, 1, tzinfo=UTC).timestamp()) * SECOND_NS
    valid = (0, NOW_NS, end_ns - SECOND_NS // 1000)
    invalid = (None, -1, end_ns, (1 << 63) - 1)
    values = [single_point(on=True, quality=0, time_ns=time_ns) for time_ns in (*valid, *invalid)]
    port = free_port()
    server = StationServer(LOOPBACK, port, station=STATION, max_connections=1)
    server.put(dict(enumerate(values)))
    server.start()
    try:
        with tapped(port) as (way, passed), closing(Master(LOOPBACK, way)) as master:
            for place in range(len(values)):
                master.read(place, STATION)
    finally:
        server.stop()
    file = tmp_path / "times.pcap"
    file.write_bytes(capture(passed))
    assert [(one.time, one.is_time_invalid) for _, one in decoded(file)] == [
        *((at(time_ns), False) for time_ns in valid),
        *((NEUTRAL, True) for _ in invalid),
    ]
