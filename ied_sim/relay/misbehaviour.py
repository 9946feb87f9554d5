"""Misbehaviour of the relay itself: a report block taken, a report buffer flooded, a restart."""

import logging
from collections.abc import Callable
from queue import SimpleQueue

from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.relay.points import RelayPoints
from ied_sim.relay.server import RelayServer
from mms import GOOD, Client, MmsError, Quality, Report, Validity

log = logging.getLogger(__name__)

OCTETS_OF_A_REPORT = 40
"""Fewer octets than the smallest report takes, so that enough changes are made to overflow the buffer."""


class RelayMisbehaviour:
    """Begins and ends the relay's own misbehaviour; used by one thread."""

    def __init__(
        self,
        misbehaviour_state: MisbehaviourState,
        server: RelayServer,
        points: RelayPoints,
        buffer_bytes: int,
        now_ns: Callable[[], int],
    ) -> None:
        self._now_ns = now_ns
        self._misbehaviour_state = misbehaviour_state
        self._server = server
        self._points = points
        self._buffer_bytes = buffer_bytes
        self._other_client: Client | None = None
        self._on: set[Kind] = set()
        self._waits = False

    def update(self) -> None:
        """Begin and end what has come on or gone off since the last update."""
        for kind in sorted(self._misbehaviour_state.kinds):
            on = self._misbehaviour_state.is_on(kind)
            if on != (kind in self._on):
                log.info("%s: %s", "misbehaves" if on else "behaves again", kind)
                (self._begin if on else self._end)(kind)
                self._on ^= {kind}
        if Kind.REPORT_TAKEN in self._on and self._other_client is None:
            self._take_report()

    def stop(self) -> None:
        """Close the connection of the other client, if there is one."""
        if self._other_client is not None:
            self._other_client.close()

    def _begin(self, kind: Kind) -> None:
        if kind is Kind.RESTART:
            self._server.go_down()
        elif kind is Kind.BUFFER_OVERFLOW:
            self._flood()

    def _end(self, kind: Kind) -> None:
        if kind is Kind.RESTART:
            self._server.come_up()
        elif kind is Kind.REPORT_TAKEN:
            self.stop()
            self._other_client = None

    def _take_report(self) -> None:
        reports, server = self._points.reports, self._server.server
        if reports is None:
            return
        try:
            client = Client.connect(server.address, server.port)
        except MmsError as error:
            log.warning("another client cannot take %s: %s", reports, error)
            return
        try:
            client.subscribe(reports, SimpleQueue[Report]())
        except MmsError as error:
            if not self._waits:
                log.warning("another client waits for %s: %s", reports, error)
            self._waits = True
            client.close()
        else:
            log.info("another client has %s", reports)
            self._other_client, self._waits = client, False

    def _flood(self) -> None:
        """Let the quality of the trip flicker: each change makes a report though nothing has happened."""
        trip = self._points.value_of("trip")
        if trip is None:
            return
        now_ns = self._now_ns()
        value = self._server.server.read(trip)
        questionable = Quality(Validity.QUESTIONABLE)
        for k in range(self._buffer_bytes // OCTETS_OF_A_REPORT):
            self._server.publish({trip: value}, now_ns + k, questionable if k % 2 == 0 else GOOD)
        self._server.publish({trip: value}, self._now_ns())
