"""Compressed ASCII event reports put together line by line, as reference for the reader."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

HEAD = (
    '"FID"',
    '"FID=SEL-710-R300-V0-Z005003-D20150101"',
    '"MONTH","DAY","YEAR","HOUR","MIN","SEC","MSEC"',
    "11,21,2024,6,30,0,250",
    '"FREQ","SAM/CYC_A","SAM/CYC_D","NUM_OF_CYC","EVENT","LOCATION","TARGETS","IA","IB"',
    '60.00,4,2,2,"TRIP   ",$$$$$$$,"ENABLED TRIP",101.5,$$$$$$$',
    '"IA","IB(kA)","VAB(kV)","VCkV","FREQ","TRIG","TRIP * RB01 RB02 * IN101 "',
)
ROWS = (
    '100,0.1,0.40,2.30,60.01,,"80"',
    '-20.5,0.2,-0.1,0,60.01,,""',
    '-100,0.3,-0.40,-2.30,60.02,,"A4"',
    '20.5,-0.1,$$$$$$$,0,60.02,,""',
    '100,-0.2,0.40,2.30,60.01,">","24"',
    "-20.5,,-0.1,0,60.01,,",
    '-100,0.3,-0.40,-2.30,60.02,"*","24"',
    '20.5,1e-1,0.1,0,60.02,"",""',
)
SETTINGS = "FNOM := 60\r\nRID := SEL-710\r\n"


def line(fields: str) -> bytes:
    """Fields with their checksum: the bytes before it, comma included, summed in 16 bits."""
    content = (fields + ",").encode("latin-1")
    total = 0
    for byte in content:
        total = (total + byte) % 65536
    return content + b'"%04X"\r\n' % total


@dataclass(frozen=True)
class CevFile:
    """A sound report of eight samples; every part can be exchanged."""

    head: Sequence[str] = HEAD
    rows: Sequence[str] = ROWS
    settings: str | None = SETTINGS
    before: bytes = b""
    after: bytes = b""

    def but(self, **changes: object) -> "CevFile":
        return replace(self, **changes)  # type: ignore[arg-type]  # the fields' own types

    def with_head(self, old: str, new: str) -> "CevFile":
        assert any(old in text for text in self.head), old
        return self.but(head=tuple(text.replace(old, new) for text in self.head))

    def content(self) -> bytes:
        parts = [*map(line, self.head), *map(line, self.rows)]
        if self.settings is not None:
            parts += [line('"SETTINGS"'), line(f'"{self.settings}"')]
        return self.before + b"".join(parts) + self.after

    def write(self, directory: Path, name: str = "report.cev") -> Path:
        path = directory / name
        path.write_bytes(self.content())
        return path


REPORT = CevFile()
