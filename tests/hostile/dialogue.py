"""What a good relay answers: a dialogue with a real server, overheard, kept as bytes to spoil."""

import asyncio
import queue
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from ied_sim.front.ber import Element, MalformedError, decode, encode
from ied_sim.front.transport import read_message, units_of
from mms import Client, FunctionalConstraint, MmsError, Report, Server
from testing.ports import LOOPBACK
from testing.relays.model import IED
from testing.relays.serving import start_relay
from testing.service.small_record import CFG, DAT
from tests.hostile.background import background_loop

SESSION = bytes([1, 0, 1, 0])
CONFIRMED_REQUEST, CONFIRMED_RESPONSE, UNCONFIRMED = b"\xa0", b"\xa1", b"\xa3"
UNIT_BYTES = 8192
PRO, CON = f"{IED}PRO", f"{IED}CON"


@dataclass
class Dialogue:
    """handshake: the server's messages before the association stands.  answers: by the request's service.

    latest: the last answer to each kind of service, for requests that were not overheard.  reports: unasked.
    """

    handshake: list[bytes] = field(default_factory=list)
    answers: dict[bytes, bytes] = field(default_factory=dict)
    latest: dict[bytes, bytes] = field(default_factory=dict)
    reports: list[bytes] = field(default_factory=list)

    def answer(self, service: Element) -> bytes | None:
        """The service part of a good response; None where none like it was overheard."""
        return self.answers.get(encode(service), self.latest.get(service.tag))


def pdu_of(user_data: bytes) -> Element | None:
    """The MMS message in a transport message; None where there is none."""
    if not user_data.startswith(SESSION):
        return None
    try:
        whole = decode(user_data[len(SESSION) :])
    except MalformedError:
        return None
    values = whole.parts[0] if whole.parts else Element(b"")
    wrapped = values.part(b"\xa0")
    return None if wrapped is None or not wrapped.parts else wrapped.parts[0]


def tlv(tag: int, content: bytes) -> bytes:
    return encode(Element(bytes([tag]), content))


def message(pdu: bytes) -> bytes:
    """An MMS message with presentation and session around it (ISO 8823, ISO 8327)."""
    values = tlv(0x30, bytes([2, 1, 3]) + tlv(0xA0, pdu))
    return SESSION + tlv(0x61, values)


def framed(user_data: bytes) -> bytes:
    return units_of(user_data, UNIT_BYTES)


def overheard() -> Dialogue:
    """A dialogue of a client that uses every service, with a small server of ours."""
    dialogue = Dialogue()
    with tempfile.TemporaryDirectory(prefix="statorwatch-hostile-") as name:
        events = Path(name) / "EVENTS"
        events.mkdir()
        (events / "HR_10001.CFG").write_bytes(CFG)
        (events / "HR_10001.DAT").write_bytes(DAT)
        (events / "HR_10002.CEV").write_bytes(bytes(200_000))
        with start_relay(file_root=Path(name)) as server, _listening(dialogue, server.port) as port:
            _use_everything(port, server)
    return dialogue


def _use_everything(port: int, server: Server) -> None:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    with Client.connect(LOOPBACK, port) as client:
        for device in client.logical_devices():
            for node in client.logical_nodes(device):
                reference = f"{device}/{node}"
                client.data_objects(reference)
                client.data_sets(reference)
                client.buffered_reports(reference)
        client.read(f"{PRO}/GGIO1.Types", FunctionalConstraint.ST)
        client.read(f"{PRO}/GGIO1.AnIn1", FunctionalConstraint.MX)
        client.read_together(
            [f"{PRO}/GGIO1.Ind01.stVal", f"{PRO}/GGIO1.Ind02.stVal"], FunctionalConstraint.ST
        )
        client.read_data_set(f"{PRO}/LLN0.DSet01")
        for control in (1, 2):
            client.operate(f"{CON}/RBGGIO1.SPCSO{control:02d}", value=True)
        client.subscribe(f"{PRO}/LLN0.BR.BRep01", reports, general_interrogation=True)
        for _ in range(2):
            server.update(f"{PRO}/GGIO1.Ind01.stVal", value=True)
            reports.get(timeout=10)
        for entry in client.files("EVENTS"):
            client.download(f"EVENTS/{entry.name.rpartition('/')[2]}", _Nowhere(), expected_size=entry.size)
        with suppress(MmsError):
            client.download("EVENTS/NONE.DAT", _Nowhere())


class _Nowhere:
    def write(self, chunk: bytes, /) -> None:
        """Kept by nobody."""


@contextmanager
def _listening(dialogue: Dialogue, target: int) -> Iterator[int]:
    """A relay of TCP that notes what passes; its port."""
    note = _Note(dialogue, target)
    with background_loop() as loop:
        starting = asyncio.start_server(note.relay, LOOPBACK, 0)
        server = asyncio.run_coroutine_threadsafe(starting, loop).result(10)
        try:
            yield int(server.sockets[0].getsockname()[1])
        finally:
            loop.call_soon_threadsafe(server.close)


class _Note:
    """Between a client and a server."""

    def __init__(self, dialogue: Dialogue, target: int) -> None:
        self._dialogue = dialogue
        self._target = target
        self._requests: dict[bytes, Element] = {}

    async def relay(self, client: asyncio.StreamReader, to_client: asyncio.StreamWriter) -> None:
        with closing(to_client):
            server, to_server = await asyncio.open_connection(LOOPBACK, self._target)
            await asyncio.gather(
                self._pass(client, to_server, self._asked), self._pass(server, to_client, self._told)
            )

    async def _pass(
        self,
        source: asyncio.StreamReader,
        sink: asyncio.StreamWriter,
        note: Callable[[bytes, bytes], None],
    ) -> None:
        try:
            with suppress(asyncio.IncompleteReadError, ConnectionError):
                while True:
                    passing = await read_message(source)
                    note(b"".join(passing.units), passing.user_data)
                    sink.write(b"".join(passing.units))
                    await sink.drain()
        finally:
            sink.close()

    def _asked(self, _units: bytes, user_data: bytes) -> None:
        pdu = pdu_of(user_data)
        if pdu is not None and pdu.tag == CONFIRMED_REQUEST and pdu.parts:
            self._requests[pdu.parts[0].content] = pdu.parts[-1]

    def _told(self, units: bytes, user_data: bytes) -> None:
        pdu = pdu_of(user_data)
        if pdu is None:
            if len(self._dialogue.handshake) < 2:  # connect confirm, accept
                self._dialogue.handshake.append(units)
        elif pdu.tag == CONFIRMED_RESPONSE and pdu.parts:
            request = self._requests.pop(pdu.parts[0].content)
            answer = encode(pdu.parts[-1])
            self._dialogue.answers[encode(request)] = answer
            self._dialogue.latest[request.tag] = answer
        elif pdu.tag == UNCONFIRMED:
            self._dialogue.reports.append(encode(pdu))
