"""COMTRADE files put together by hand, field by field, as reference for the reader."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

ANALOG_LINES = (
    "1,IA,A,,A,0.01,0,0,-32767,32767,100,5,P",
    "2,IB,B,,A,0.01,0,0,-32767,32767,100,5,P",
    "3,IC,C,,A,0.01,0,0,-32767,32767,100,5,P",
    "4,VAB,AB,,kV,0.0001,0.5,0,-32767,32767,400,100,P",
)
STATUS_LINES = ("1,TRIP,,,0", "2,RB01,,,0")
ROWS = ((0, 100, -100, 4), (1000, -500, -500, 5), (-2000, 1500, 500, 6), (3000, -3000, 0, -7), (1, 2, 3, 8))


@dataclass(frozen=True)
class ComtradeFile:
    """A sound 1999 record of five samples at 1 kHz; every part can be exchanged."""

    identification: str = "PLANT,RELAY 1,1999"
    counts: str = "6,4A,2D"
    analog: tuple[str, ...] = ANALOG_LINES
    status: tuple[str, ...] = STATUS_LINES
    frequency: str = "50"
    rates: tuple[str, ...] = ("1", "1000,5")
    start: str = "21/11/2024,06:30:00.250000"
    trigger: str = "21/11/2024,06:30:00.252000"
    data_format: str = "BINARY"
    tail: tuple[str, ...] = ("1",)
    rows: Sequence[Sequence[float]] = ROWS
    numbers: Sequence[int] = (1, 2, 3, 4, 5)
    stamps: Sequence[int | None] = (0, 1000, 2000, 3000, 4000)
    status_bits: int = 0b10
    line_end: str = "\r\n"

    def but(self, **changes: object) -> "ComtradeFile":
        return replace(self, **changes)  # type: ignore[arg-type]  # the fields' own types

    def configuration(self) -> str:
        lines = (
            self.identification, self.counts, *self.analog, *self.status, self.frequency, *self.rates,
            self.start, self.trigger, self.data_format, *self.tail,
        )  # fmt: skip
        return self.line_end.join(lines) + self.line_end

    def data(self) -> bytes:
        samples = zip(self.numbers, self.stamps, self.rows, strict=True)
        if self.data_format == "ASCII":
            bits = [str(self.status_bits >> k & 1) for k in range(len(self.status))]
            lines = [
                ",".join([str(n), "" if t is None else str(t), *(f"{v:g}" for v in row), *bits])
                for n, t, row in samples
            ]
            return (self.line_end.join(lines) + self.line_end).encode()
        code = {"BINARY": "h", "BINARY32": "i", "FLOAT32": "f"}[self.data_format]
        words = -(-len(self.status) // 16)
        return b"".join(
            struct.pack(
                f"<II{len(row)}{code}{words}H",
                n,
                0xFFFFFFFF if t is None else t,
                *row,
                *[self.status_bits] * words,
            )
            for n, t, row in samples
        )

    def write(self, directory: Path, *, name: str = "record.cfg", data_name: str = "record.dat") -> Path:
        path = directory / name
        path.write_bytes(self.configuration().encode())
        (directory / data_name).write_bytes(self.data())
        return path


RECORD_1999 = ComtradeFile()
RECORD_1991 = RECORD_1999.but(
    identification="PLANT,RELAY 1",
    analog=tuple(",".join(line.split(",")[:10]) for line in ANALOG_LINES),
    status=("1,TRIP,0", "2,RB01,0"),
    start="11/21/24,06:30:00.250000",
    trigger="11/21/24,06:30:00.252000",
    tail=(),
)
RECORD_2013 = RECORD_1999.but(identification="PLANT,RELAY 1,2013", tail=("1", "0,0", "0,0"))


def unsigned(analog: tuple[str, ...]) -> tuple[str, ...]:
    """Lines of analogue channels whose limits have no sign."""
    return tuple(line.replace("-32767,32767", "0,32767") for line in analog)
