"""A client of IEC 60870-5-104 from the standard's octets: it shares nothing with the server's library."""

import socket
import struct
from dataclasses import dataclass
from datetime import UTC, datetime

START = b"\x68"
SINGLE, WHOLE, FLOAT = 30, 35, 36
"""Types M_SP_TB_1, M_ME_TE_1 and M_ME_TF_1."""
PLAIN_SINGLE, PLAIN_WHOLE, PLAIN_FLOAT = 1, 11, 13
"""The same without a time: M_SP_NA_1, M_ME_NB_1 and M_ME_NC_1."""
ELEMENT_OCTETS = {SINGLE: 1, WHOLE: 3, FLOAT: 5, PLAIN_SINGLE: 1, PLAIN_WHOLE: 3, PLAIN_FLOAT: 5}
"""Of the value and its quality, by type."""

INTERROGATION, READING = 100, 102
SPONTANEOUS, REQUESTED, INTERROGATED = 3, 5, 20
UNKNOWN = 44
"""Causes from here on: unknown type, cause, common address or object address."""
INVALID, NOT_TOPICAL = 0x80, 0x40


@dataclass(frozen=True, slots=True)
class Told:
    """An information object. kind: its type.  cause: why it was sent.

    tag: CP56Time2a, of the latest telegram that had one; empty where none had.
    """

    kind: int
    cause: int
    value: float
    quality: int
    tag: bytes

    @property
    def time(self) -> datetime:
        """Its time, which has to be valid."""
        assert self.tag, "no telegram has told its time"
        assert not self.is_time_invalid
        return _time(self.tag)

    @property
    def is_time_invalid(self) -> bool:
        """Whether its time says of itself that it is invalid (IV)."""
        return bool(self.tag[2] & 0x80)


class Master:
    """A controlling station that has begun the data transfer. link: a connection that stands already."""

    def __init__(self, host: str, port: int, link: socket.socket | None = None) -> None:
        self._link = link or socket.create_connection((host, port), timeout=20)
        self._sent, self._received = 0, 0
        self._is_negative = False
        self.told: dict[int, Told] = {}
        self._send(b"\x07\x00\x00\x00")  # STARTDT act
        assert self._frame() == b"\x0b\x00\x00\x00"  # STARTDT con

    def close(self) -> None:
        """End the connection."""
        self._link.close()

    def interrogate(self, station: int = 1) -> None:
        """Ask for everything, and read until the station says that it was all."""
        self._ask(bytes([INTERROGATION, 1, 6, 0]) + struct.pack("<H", station) + b"\x00\x00\x00\x14")
        while self._read() != (INTERROGATION, 10):  # activation termination
            pass

    def read(self, place: int, station: int = 1) -> Told:
        """Ask for one address, and return what is told of it."""
        self._ask(bytes([READING, 1, 5, 0]) + struct.pack("<H", station) + place.to_bytes(3, "little"))
        while self._read()[1] != REQUESTED:
            pass
        return self.told[place]

    def is_command_refused(self, station: int = 1) -> bool:
        """Send a single command to an address; return whether the station confirms it negatively."""
        self._ask(bytes([45, 1, 6, 0]) + struct.pack("<H", station) + b"\xe8\x03\x00\x01")
        while True:
            kind, cause = self._read()
            if kind == 45:
                return self._is_negative or cause >= UNKNOWN

    def next_change(self) -> None:
        """Read until something has been told by itself."""
        while self._read()[1] != SPONTANEOUS:
            pass

    def _ask(self, unit: bytes) -> None:
        self._send(struct.pack("<HH", self._sent << 1, self._received << 1) + unit)
        self._sent += 1

    def _send(self, content: bytes) -> None:
        self._link.sendall(START + bytes([len(content)]) + content)

    def _frame(self) -> bytes:
        head = self._exactly(2)
        assert head[:1] == START
        return self._exactly(head[1])

    def _exactly(self, size: int) -> bytes:
        content = b""
        while len(content) < size:
            part = self._link.recv(size - len(content))
            if not part:
                raise ConnectionError("the station has ended the connection")
            content += part
        return content

    def _read(self) -> tuple[int, int]:
        """Read one telegram; return its type and cause."""
        frame = self._frame()
        while frame[0] & 1:  # S and U formats have no information
            if frame == b"\x43\x00\x00\x00":
                self._send(b"\x83\x00\x00\x00")  # TESTFR con
            frame = self._frame()
        self._received = (self._received + 1) & 0x7FFF
        self._send(struct.pack("<HH", 1, self._received << 1))  # S format: acknowledged
        kind, number, cause = frame[4], frame[5], frame[6] & 0x3F
        self._is_negative = bool(frame[6] & 0x40)
        body = frame[10:]
        if kind in ELEMENT_OCTETS:
            assert not number & 0x80, "each object has its own address"
            step = 3 + ELEMENT_OCTETS[kind] + (7 if kind in (SINGLE, WHOLE, FLOAT) else 0)
            assert len(body) == step * number
            for at in range(0, step * number, step):
                self._take(kind, cause, body[at : at + step])
        return kind, cause

    def _take(self, kind: int, cause: int, element: bytes) -> None:
        place = int.from_bytes(element[:3], "little")
        value: float
        if kind in (SINGLE, PLAIN_SINGLE):
            value, quality = element[3] & 1, element[3] & 0xF0
        elif kind in (WHOLE, PLAIN_WHOLE):
            value, quality = int.from_bytes(element[3:5], "little", signed=True), element[5]
        else:
            value, quality = struct.unpack("<f", element[3:7])[0], element[7]
        tag = element[3 + ELEMENT_OCTETS[kind] :]
        if not tag and place in self.told:
            tag = self.told[place].tag
        self.told[place] = Told(kind, cause, value, quality, tag)


def _time(octets: bytes) -> datetime:
    """CP56Time2a."""
    milliseconds = int.from_bytes(octets[:2], "little")
    year = octets[6] & 0x7F
    return datetime(
        (1900 if year >= 70 else 2000) + year,
        octets[5] & 0x0F,
        octets[4] & 0x1F,
        octets[3] & 0x1F,
        octets[2] & 0x3F,
        milliseconds // 1000,
        1000 * (milliseconds % 1000),
        tzinfo=UTC,
    )
