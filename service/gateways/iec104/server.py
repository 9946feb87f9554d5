"""A controlled station of IEC 60870-5-104 that is monitored only, on a thread of its own.

It is ours because the library at hand, c104 2.2 on lib60870, is ended by malformed data units of any client,
such as a clock command that is cut off, and kept from all other work by one that begins no handshake of TLS.
"""

import asyncio
import threading
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

from service.gateways.iec104.security import Security
from service.gateways.iec104.session import Session
from service.gateways.iec104.telegrams import EVERY_STATION, TEST, Cause, Type, Unit, Value, units_of

WHOLE_STATION: Final = 20
"""Qualifier of an interrogation; those of groups are refused."""
BEGIN_S: Final = 86_400.0
"""So long a connection may be without data transfer. The standby of a redundant station has none either."""
END_S: Final = 10.0


class StationServer:
    """Tells values by their addresses, when it is asked and when they change.

    Parameters
    ----------
    host, port
        Where it listens.
    station
        The common address.
    max_connections
        Of controlling stations at a time.
    security
        None without TLS.
    begin_within_s
        Time in which a connection has to begin the data transfer.
    """

    def __init__(
        self,
        host: str,
        port: int,
        *,
        station: int,
        max_connections: int,
        security: Security | None = None,
        begin_within_s: float = BEGIN_S,
    ) -> None:
        self._host, self._port = host, port
        self._station = station
        self._max_connections = max_connections
        self._security = security
        self._begin_within_s = begin_within_s
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="IEC 104", daemon=True)
        self._values: dict[int, Value] = {}
        self._sessions: set[Session] = set()
        self._server: asyncio.Server | None = None

    @property
    def is_listening(self) -> bool:
        """Return whether it has begun."""
        return self._server is not None

    def start(self) -> None:
        """Listen. Raises OSError; it may be tried again."""
        if not self._thread.is_alive():
            self._thread.start()
        self._server = asyncio.run_coroutine_threadsafe(self._listening(), self._loop).result(END_S)

    def stop(self) -> None:
        """End every connection."""
        if not self._thread.is_alive():
            self._loop.close()
            return
        asyncio.run_coroutine_threadsafe(self._end(), self._loop).result(END_S)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(END_S)
        self._loop.close()

    def put(self, values: Mapping[int, Value]) -> None:
        """Keep these values, and tell them to whoever is connected."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._put, values)
        else:
            self._values.update(values)

    def _put(self, values: Mapping[int, Value]) -> None:
        self._values.update(values)
        told = list(units_of(values.items(), Cause.SPONTANEOUS, self._station))
        for session in self._sessions:
            session.tell(told)

    async def _listening(self) -> asyncio.Server:
        return await self._loop.create_server(self._new_session, self._host, self._port)

    def _new_session(self) -> Session:
        return Session(
            self._answers,
            on_open=self._opened,
            on_close=self._sessions.discard,
            security=self._security,
            begin_within_s=self._begin_within_s,
        )

    async def _end(self) -> None:
        if self._server is not None:
            self._server.close()
        ended = list(self._sessions)
        for session in ended:
            session.end("the gateway ends")
        await asyncio.gather(*(one.securing for one in ended if one.securing is not None))
        await asyncio.sleep(0)

    def _opened(self, session: Session) -> bool:
        """Tell whether there is a place for a connection. One that transfers no data gives way to it.

        Those in a handshake of TLS do so first, and the oldest of them: who means it has begun by then.
        """
        if len(self._sessions) >= self._max_connections:
            idle = [one for one in self._sessions if not one.is_started]
            if not idle:
                return False
            oldest = min(idle, key=lambda one: (one.is_secured, one.waiting_since_s))
            self._sessions.discard(oldest)
            oldest.end("it transfers no data, and another one wants its place")
        self._sessions.add(session)
        return True

    def _answers(self, unit: Unit) -> Iterable[Unit]:
        """Yield the answers to a unit that a controlling station has sent."""
        is_for_all = unit.station == EVERY_STATION and unit.kind in (Type.C_IC_NA_1, Type.C_CS_NA_1)
        if unit.station != self._station and not is_for_all:
            yield unit.answer(Cause.UNKNOWN_STATION, negative=True)
            return
        unit = replace(unit, station=self._station)
        if unit.kind == Type.C_IC_NA_1:
            yield from self._interrogated(unit)
        elif unit.kind == Type.C_RD_NA_1:
            yield from self._read(unit)
        elif unit.kind == Type.C_CS_NA_1:  # the clock of this machine is not the other system's to set
            yield unit.answer(Cause.ACTIVATION_CONFIRMATION, negative=True)
        else:
            yield unit.answer(Cause.UNKNOWN_TYPE, negative=True)

    def _interrogated(self, unit: Unit) -> Iterable[Unit]:
        if unit.cause & ~TEST != Cause.ACTIVATION:
            yield unit.answer(Cause.UNKNOWN_CAUSE, negative=True)
        elif unit.place != 0:
            yield unit.answer(Cause.UNKNOWN_OBJECT, negative=True)
        elif unit.body[3:] != bytes([WHOLE_STATION]):
            yield unit.answer(Cause.ACTIVATION_CONFIRMATION, negative=True)
        else:
            yield unit.answer(Cause.ACTIVATION_CONFIRMATION)
            # Types with a time are for what is told by itself, or read (IEC 60870-5-104, clause 9).
            values = [(place, value.without_time()) for place, value in self._values.items()]
            yield from units_of(sorted(values, key=_by_kind), Cause.INTERROGATED, self._station)
            yield unit.answer(Cause.ACTIVATION_TERMINATION)

    def _read(self, unit: Unit) -> Iterable[Unit]:
        value = self._values.get(unit.place)
        if unit.cause & ~TEST != Cause.REQUEST:
            yield unit.answer(Cause.UNKNOWN_CAUSE, negative=True)
        elif value is None:
            yield unit.answer(Cause.UNKNOWN_OBJECT, negative=True)
        else:
            yield from units_of([(unit.place, value)], Cause.REQUEST, self._station)


def _by_kind(one: tuple[int, Value]) -> tuple[Type, int]:
    place, value = one
    return value.kind, place
