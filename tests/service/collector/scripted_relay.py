"""A relay for the collector's tests: the real model over real MMS, doing exactly what the test says."""

import time
from dataclasses import dataclass, field
from pathlib import Path

import scl
from mms import AddCause, ControlAction, FileAnswer, FileOperation, FileRequest, Server, Timestamp, Value
from scl.model_text import model_text

NAME = "A1_SEL710"
CONTROL = f"{NAME}CON/RBGGIO1.SPCSO01"
RECORD_MADE = f"{NAME}PRO/FLTRDRE1.RcdMade"
FAULT_NUMBER = f"{NAME}PRO/FLTRDRE1.FltNum"
STUCK_S = 2.5
"""Longer than the bench's collector waits for an answer."""

REPORT_CONTROL = f"{NAME}CFG/LLN0.BR.BRep01"


@dataclass
class ScriptedRelay:
    """Writes a record at each rising edge of RB01, unless told to refuse or to stay silent.

    denied: files of these records cannot be opened.  stuck: asked for these, it answers nobody for STUCK_S.
    listings: how often its directory was asked for.
    shifts: a file of SHIFTY is a byte longer whenever it is opened than it was when it was listed.
    clock_offset_s: it stamps changes of RB01 with a clock so far ahead; None: it stamps nothing.
    """

    root: Path
    port: int
    refuses: bool = False
    silent: bool = False
    busy: bool = False
    shifts: bool = False
    denied: set[str] = field(default_factory=set)
    stuck: set[str] = field(default_factory=set)
    clock_offset_s: float | None = None
    clock_quality: int = 0x0A
    edges: int = 0
    records: int = 0
    listings: int = 0
    server: Server = field(init=False)
    _bit: bool = False

    def __post_init__(self) -> None:
        self.events.mkdir(parents=True, exist_ok=True)
        text = model_text(scl.read(scl.DEMO_PLANT_SCD), NAME)
        self.server = Server(text, port=self.port, file_root=self.root, on_file_request=self._answer)
        self.server.on_operate(CONTROL, self._operated)
        self.server.start()

    @property
    def events(self) -> Path:
        return self.root / "EVENTS"

    def stop(self) -> None:
        self.server.stop()

    def write_record(self, name: str, data: bytes = b"samples", *, report: bool = True) -> None:
        """A finished record, announced by a report."""
        self.write_file(f"{name}.DAT", data)
        self.write_file(f"{name}.CFG", f"configuration of {name}".encode())
        self.records += 1
        if report:
            self.announce()

    def write_file(self, name: str, content: bytes) -> None:
        (self.events / name).write_bytes(content)

    def announce(self) -> None:
        """RcdMade and FltNum, as a relay sets them when a record is ready."""
        self.server.update_many({f"{RECORD_MADE}.stVal": False})
        self.server.update_many({f"{RECORD_MADE}.stVal": True, f"{FAULT_NUMBER}.stVal": self.records})

    def _answer(self, request: FileRequest) -> FileAnswer:
        self.listings += request.operation is FileOperation.LIST
        if self.shifts and request.operation is FileOperation.OPEN and "SHIFTY" in request.path.name:
            with request.path.open("ab") as file:
                file.write(b"+")
        if request.operation is not FileOperation.OPEN:
            return FileAnswer.SERVE
        if request.path.stem in self.stuck:
            time.sleep(STUCK_S)
        if request.path.stem in self.denied:
            return FileAnswer.DENIED
        return FileAnswer.BUSY if self.busy else FileAnswer.SERVE

    def _operated(self, action: ControlAction) -> "bool | AddCause":
        if self.refuses:
            return AddCause.BLOCKED_BY_SWITCHING_HIERARCHY
        rising = action.value is True and not self._bit
        self._bit = action.value is True
        changes: dict[str, Value] = {f"{CONTROL}.stVal": self._bit}
        if self.clock_offset_s is not None:
            now_ns = time.time_ns() + round(self.clock_offset_s * 1e9)
            changes[f"{CONTROL}.t"] = Timestamp(now_ns, self.clock_quality)
        self.server.update_many(changes)
        if rising:
            self.edges += 1
            if not self.silent:
                self.write_record(f"HR_{10000 + self.edges}", f"record {self.edges}".encode())
        return True
