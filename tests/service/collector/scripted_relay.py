"""A relay for the collector's tests: the real model over real MMS, doing exactly what the test says."""

import ctypes
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import scl
from core.units import NANOSECONDS_PER_SECOND
from mms import (
    AddCause,
    ControlAction,
    DataAccessError,
    FileAnswer,
    FileOperation,
    FileRequest,
    FunctionalConstraint,
    Server,
    Timestamp,
    Value,
)
from mms.server.model import Node
from scl.model_text import model_text

NAME = "A1_SEL710"
CONTROL = f"{NAME}CON/RBGGIO1.SPCSO01"
RECORD_MADE = f"{NAME}PRO/FLTRDRE1.RcdMade"
FAULT_NUMBER = f"{NAME}PRO/FLTRDRE1.FltNum"
STUCK_S = 2.5
"""Longer than the bench's collector waits for an answer."""

REPORT_CONTROL = f"{NAME}CFG/LLN0.BR.BRep01"


_Address = ctypes.c_void_p
_ReadAccessHandler = ctypes.CFUNCTYPE(
    ctypes.c_int, _Address, _Address, _Address, ctypes.c_int, _Address, _Address
)
_SERVE = -1


@dataclass
class ScriptedRelay:
    """Writes a record at each rising edge of RB01, unless told to refuse or to stay silent.

    denied: files of these records cannot be opened.  absent: those of these are listed, and not found.
    stuck: asked for these, it answers nobody for STUCK_S.
    listings: how often its directory was asked for.  opened: how many files.
    shifts: a file of SHIFTY is a byte longer whenever it is opened than it was when it was listed.
    clock_offset_s: it stamps changes of RB01 with a clock so far ahead; None: it stamps nothing.
    unreadable: what it answers for each of these data objects in place of values.
    on_file_request: is told of each request for a file or listing; what it answers is the answer.
    unreadable_while_set: what it answers for the status of RB01 while that is set.
    """

    root: Path
    port: int
    refuses: bool = False
    silent: bool = False
    busy: bool = False
    shifts: bool = False
    denied: set[str] = field(default_factory=set)
    absent: set[str] = field(default_factory=set)
    stuck: set[str] = field(default_factory=set)
    opening_s: float = 0.0
    clock_offset_s: float | None = None
    clock_quality: int = 0x0A
    unreadable: dict[str, DataAccessError] = field(default_factory=dict)
    unreadable_while_set: DataAccessError | None = None
    on_file_request: Callable[[FileRequest], FileAnswer | None] | None = None
    edges: int = 0
    records: int = 0
    listings: int = 0
    opened: int = 0
    server: Server = field(init=False)
    is_set: bool = False

    def __post_init__(self) -> None:
        self.events.mkdir(parents=True, exist_ok=True)
        text = model_text(scl.read(scl.DEMO_PLANT_SCD), NAME)
        self.server = Server(text, port=self.port, file_root=self.root, on_file_request=self._answer)
        self.server.on_operate(CONTROL, self._operated)
        self._refuse_reads()
        self.server.start()

    def _refuse_reads(self) -> None:
        """The library's own hook, which the MMS layer has no other use for."""

        def answer(
            _device: int, _node: int, data_object: int, constraint: int, _client: int, _parameter: int
        ) -> int:
            unreadable = dict(self.unreadable)
            is_status = constraint == FunctionalConstraint.ST
            if self.is_set and is_status and self.unreadable_while_set is not None:
                unreadable[CONTROL] = self.unreadable_while_set
            for reference, error in unreadable.items():
                if self.server._model.node(reference, Node.DATA_OBJECT) == data_object:
                    return int(error.value)
            return _SERVE

        self._handler = _ReadAccessHandler(answer)
        install = self.server._lib.IedServer_setReadAccessHandler
        install.restype, install.argtypes = None, [_Address, _ReadAccessHandler, _Address]
        install(self.server._server, self._handler, None)

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

    def write_untimed(self, name: str, content: bytes) -> None:
        """A file that is listed with the time 0, as relays without file times do."""
        self.write_file(name, content)
        os.utime(self.events / name, (0, 0))

    def announce(self) -> None:
        """RcdMade and FltNum, as a relay sets them when a record is ready."""
        self.server.update_many({f"{RECORD_MADE}.stVal": False})
        self.server.update_many({f"{RECORD_MADE}.stVal": True, f"{FAULT_NUMBER}.stVal": self.records})

    def _answer(self, request: FileRequest) -> FileAnswer:
        told = None if self.on_file_request is None else self.on_file_request(request)
        if told is not None:
            return told
        self.listings += request.operation is FileOperation.LIST
        if self.shifts and request.operation is FileOperation.OPEN and "SHIFTY" in request.path.name:
            with request.path.open("ab") as file:
                file.write(b"+")
        if request.operation is not FileOperation.OPEN:
            return FileAnswer.SERVE
        self.opened += 1
        if request.path.stem in self.stuck:
            time.sleep(STUCK_S)
        time.sleep(self.opening_s)
        if request.path.stem in self.denied:
            return FileAnswer.DENIED
        if request.path.stem in self.absent:
            return FileAnswer.ABSENT
        return FileAnswer.BUSY if self.busy else FileAnswer.SERVE

    def _operated(self, action: ControlAction) -> "bool | AddCause":
        if self.refuses:
            return AddCause.BLOCKED_BY_SWITCHING_HIERARCHY
        rising = action.value is True and not self.is_set
        self.is_set = action.value is True
        changes: dict[str, Value] = {f"{CONTROL}.stVal": self.is_set}
        if self.clock_offset_s is not None:
            now_ns = time.time_ns() + round(self.clock_offset_s * NANOSECONDS_PER_SECOND)
            changes[f"{CONTROL}.t"] = Timestamp(now_ns, self.clock_quality)
        self.server.update_many(changes)
        if rising:
            self.edges += 1
            if not self.silent:
                self.write_record(f"HR_{10000 + self.edges}", f"record {self.edges}".encode())
        return True
