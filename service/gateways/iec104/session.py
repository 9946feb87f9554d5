"""A controlling station's connection: numbers, acknowledgements, times (IEC 60870-5-104, 5.1 to 5.5)."""

import asyncio
from collections import deque
from collections.abc import Callable, Iterable
from typing import Final

import structlog

from service.gateways.iec104.security import Security
from service.gateways.iec104.telegrams import (
    Control,
    MalformedError,
    Unit,
    acknowledging,
    frames,
    numbered,
    unnumbered,
)

log = structlog.get_logger(__name__)

MOST_UNACKNOWLEDGED: Final = 12
"""k: units that are sent before the first of them is acknowledged."""
ACKNOWLEDGED_AFTER: Final = 8
"""w: units that are received before they are acknowledged."""
ANSWER_S: Final = 15.0
"""t1: time in which what was sent has to be acknowledged."""
ACKNOWLEDGED_WITHIN_S: Final = 10.0
"""t2: time in which what was received is acknowledged."""
IDLE_S: Final = 20.0
"""t3: time without anything received after which the other side is tested."""
NUMBERS: Final = 1 << 15
LOOK_S: Final = 1.0
MOST_WAITING: Final = 50_000
"""Units that wait for a station that takes them slowly: some changes of every value of the largest plant."""

Answer = Callable[[Unit], Iterable[Unit]]
"""What a unit that has come is answered with."""


class Session(asyncio.Protocol):
    """One connection. `on_open` may refuse it: it is closed at once then.

    security: None without TLS.  begin_within_s: time in which the data transfer has to begin.
    """

    def __init__(
        self,
        answer: Answer,
        *,
        on_open: Callable[["Session"], bool],
        on_close: Callable[["Session"], None],
        security: Security | None,
        begin_within_s: float,
    ) -> None:
        self._answer = answer
        self._on_open = on_open
        self._on_close = on_close
        self._security = security
        self._begin_within_s = begin_within_s
        self._loop = asyncio.get_running_loop()
        self._buffer = bytearray()
        self._waiting: deque[bytes] = deque()
        self._sent_s: deque[float] = deque()
        self._sent = self._received = self._unacknowledged = 0
        self._received_s = self._owed_since_s = 0.0
        self._tested_s: float | None = None
        self._timer: asyncio.TimerHandle | None = None
        self.transport: asyncio.Transport | None = None
        self.securing: asyncio.Task[None] | None = None
        self.is_secured = security is None
        self.is_started = False
        self.waiting_since_s = self._loop.time()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin; nothing is told before the other side asks for it."""
        assert isinstance(transport, asyncio.Transport)  # noqa: S101 - of a TCP server
        self.transport = transport
        if not self._on_open(self):
            transport.abort()
        elif self._security is None:
            self._begin()
        else:
            self.securing = self._loop.create_task(self._secure(transport, self._security))

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget what was to be sent."""
        del exc
        if self._timer is not None:
            self._timer.cancel()
        self.is_started = False
        self._waiting.clear()
        self._on_close(self)

    def pause_writing(self) -> None:
        """Hear no more from who takes no answers."""
        if self.transport is not None:
            self.transport.pause_reading()

    def resume_writing(self) -> None:
        """Go on."""
        if self.transport is not None:
            self.transport.resume_reading()

    def data_received(self, data: bytes) -> None:
        """Answer what has come; end the connection where it is none of the protocol."""
        self._received_s = self._loop.time()
        self._buffer += data
        if self.is_secured:
            self._take_frames()

    def tell(self, units: Iterable[Unit]) -> None:
        """Send these, or keep them until the other side has acknowledged others."""
        if not self.is_started:
            return
        self._waiting.extend(unit.octets() for unit in units)
        if len(self._waiting) > MOST_WAITING:
            self.end("it takes less than there is to be told")
        self._send_waiting()

    def end(self, reason: str) -> None:
        """End the connection at once."""
        if self.transport is not None and not self.transport.is_closing():
            peer = self.transport.get_extra_info("peername")
            log.warning("a connection is ended", client=str(peer), reason=reason)
            self.transport.abort()

    async def _secure(self, transport: asyncio.Transport, security: Security) -> None:
        """Begin behind the handshake of TLS; nothing that came with it is heard before."""
        secured = await security.secured(transport, self)
        if secured is None:
            self._on_close(self)  # nobody else tells it of a connection that ends in the handshake
            return
        self.transport, self.is_secured = secured, True
        self._begin()
        self._take_frames()

    def _begin(self) -> None:
        self._received_s = self.waiting_since_s = self._loop.time()
        self._timer = self._loop.call_later(LOOK_S, self._look)

    def _take_frames(self) -> None:
        try:
            for frame in frames(self._buffer):
                self._take(frame)
        except MalformedError as error:
            self.end(str(error))

    def _take(self, frame: bytes) -> None:
        """Raises MalformedError."""
        control = frame[0]
        if control & 1 == 0:
            self._take_unit(frame)
        elif len(frame) != 4:
            raise MalformedError(f"expected a frame of 4 octets, found {len(frame)}")
        elif control & 3 == 1:
            self._acknowledge(int.from_bytes(frame[2:4], "little") >> 1)
        elif control == Control.START_ACTIVATION:
            self.is_started = True
            self._write(unnumbered(Control.START_CONFIRMATION))
        elif control == Control.STOP_ACTIVATION:
            self.is_started = False
            self.waiting_since_s = self._loop.time()
            self._waiting.clear()
            self._owe_nothing()
            self._write(unnumbered(Control.STOP_CONFIRMATION))
        elif control == Control.TEST_ACTIVATION:
            self._write(unnumbered(Control.TEST_CONFIRMATION))
        elif control == Control.TEST_CONFIRMATION:
            self._tested_s = None
        else:
            raise MalformedError(f"expected a control function, found {control:#x}")

    def _take_unit(self, frame: bytes) -> None:
        number, acknowledged = (int.from_bytes(frame[at : at + 2], "little") >> 1 for at in (0, 2))
        if not self.is_started:
            raise MalformedError("expected the start of the data transfer, found data")
        if number != self._received:
            raise MalformedError(f"expected unit {self._received}, found {number}")
        unit = Unit.read(frame[4:])
        self._acknowledge(acknowledged)
        self._received = (self._received + 1) % NUMBERS
        if self._unacknowledged == 0:
            self._owed_since_s = self._loop.time()
        self._unacknowledged += 1
        self.tell(self._answer(unit))
        if self._unacknowledged >= ACKNOWLEDGED_AFTER:
            self._owe_nothing()

    def _acknowledge(self, number: int) -> None:
        """Take the other side's word for all units before this number. Raises MalformedError."""
        left = (self._sent - number) % NUMBERS
        if left > len(self._sent_s):
            raise MalformedError(f"expected an acknowledgement of what was sent, found one of {number}")
        while len(self._sent_s) > left:
            self._sent_s.popleft()
        self._send_waiting()

    def _send_waiting(self) -> None:
        while self.is_started and self._waiting and len(self._sent_s) < MOST_UNACKNOWLEDGED:
            self._write(numbered(self._sent, self._received, self._waiting.popleft()))
            self._sent = (self._sent + 1) % NUMBERS
            self._sent_s.append(self._loop.time())
            self._unacknowledged = 0

    def _owe_nothing(self) -> None:
        """Acknowledge what was received, unless what was sent has done so."""
        if self._unacknowledged:
            self._unacknowledged = 0
            self._write(acknowledging(self._received))

    def _write(self, frame: bytes) -> None:
        if self.transport is not None and not self.transport.is_closing():
            self.transport.write(frame)

    def _look(self) -> None:
        """Keep the times of the standard."""
        now_s = self._loop.time()
        self._timer = self._loop.call_later(LOOK_S, self._look)
        if self._sent_s and now_s - self._sent_s[0] > ANSWER_S:
            self.end(f"nothing sent was acknowledged for {ANSWER_S:g} s")
        elif self._tested_s is not None and now_s - self._tested_s > ANSWER_S:
            self.end(f"a test was not answered within {ANSWER_S:g} s")
        elif not self.is_started and now_s - self.waiting_since_s > self._begin_within_s:
            self.end(f"it did not begin the data transfer within {self._begin_within_s:g} s")
        elif self._tested_s is None and now_s - self._received_s > IDLE_S:
            self._tested_s = now_s
            self._write(unnumbered(Control.TEST_ACTIVATION))
        if self._unacknowledged and now_s - self._owed_since_s > ACKNOWLEDGED_WITHIN_S:
            self._owe_nothing()
