"""Publish the states of a data set: each at once, then again at growing intervals (IEC 61850-8-1)."""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mms.goose.frame import GooseFrame, encode_frame
from mms.goose.message import GooseMessage
from mms.goose.subscription import following
from mms.values import Timestamp, Value

LIVES = 3
"""A message lives so many intervals: the next two may get lost."""
SHORTEST_LIFE_MS = 500
"""A busy machine may be late with the first repetitions, which come within milliseconds."""


@dataclass(frozen=True, slots=True)
class PublishedBlock:
    """A control block as its SCL describes it.

    Parameters
    ----------
    reference : str
        Reference of the block, "A1_SEL710CFG/LLN0$GO$GPub01".
    data_set : str
        Reference of its data set.
    goose_id : str
        Identification of its messages.
    configuration_revision : int
        Revision of the data set.
    destination : bytes
        Multicast address, six octets.
    application_id : int
        APPID.
    vlan_id : int or None
        Virtual LAN; 0 for a tag with the priority alone (IEC 61850-8-1), None to send without a tag.
    vlan_priority : int
        Priority in the virtual LAN.
    minimum_time_ms : int
        First interval after a change [ms]; each further one is twice as long.
    maximum_time_ms : int
        Longest interval [ms].
    """

    reference: str
    data_set: str
    goose_id: str
    configuration_revision: int
    destination: bytes
    application_id: int
    vlan_id: int | None = None
    vlan_priority: int = 4
    minimum_time_ms: int = 4
    maximum_time_ms: int = 1000


class Publisher:
    """States of one control block, and when each is to be told. It sends nothing itself.

    Parameters
    ----------
    block : PublishedBlock
        The block.
    source : bytes
        Address of the sender, six octets.
    values : sequence of Value
        Values of its data set.
    time_ns : int
        Since when they are so [ns, UTC].
    simulation : bool
        Whether the messages are those of a test set.
    """

    def __init__(
        self,
        block: PublishedBlock,
        source: bytes,
        values: Sequence[Value],
        time_ns: int,
        *,
        simulation: bool = False,
    ) -> None:
        self._block = block
        self._source = source
        self._simulation = simulation
        self._values = tuple(values)
        self._time = Timestamp(time_ns)
        self._state_number = 1
        self._sequence_number = 0
        self._interval_ms = block.minimum_time_ms
        self.due_s = 0.0
        """When the state is to be told next, by a steady clock [s]; 0 for at once."""

    def change(self, values: Sequence[Value], time_ns: int) -> None:
        """Begin a new state, which is due at once.

        Parameters
        ----------
        values : sequence of Value
            Values of the data set.
        time_ns : int
            When they became so [ns, UTC].
        """
        self._values, self._time = tuple(values), Timestamp(time_ns)
        self._state_number, self._sequence_number = following(self._state_number), 0
        self._interval_ms = self._block.minimum_time_ms
        self.due_s = 0.0

    def next_frame(self, now_s: float) -> bytes:
        """Tell the state once more.

        Parameters
        ----------
        now_s : float
            Time of a steady clock [s].

        Returns
        -------
        bytes
            The frame to be sent now.
        """
        block, interval_ms = self._block, self._interval_ms
        message = GooseMessage(
            control_block=block.reference,
            time_allowed_to_live_ms=max(LIVES * interval_ms, SHORTEST_LIFE_MS),
            data_set=block.data_set,
            goose_id=block.goose_id,
            time=self._time,
            state_number=self._state_number,
            sequence_number=self._sequence_number,
            simulation=self._simulation,
            configuration_revision=block.configuration_revision,
            needs_commissioning=False,
            values=self._values,
        )
        self._sequence_number = following(self._sequence_number)
        self._interval_ms = min(2 * interval_ms, block.maximum_time_ms)
        self.due_s = now_s + interval_ms / 1000
        return encode_frame(
            GooseFrame(
                destination=block.destination,
                source=self._source,
                application_id=block.application_id,
                message=message,
                vlan_id=block.vlan_id,
                vlan_priority=block.vlan_priority,
                simulated=self._simulation,
            )
        )


class PublisherThread:
    """Sends the frames of publishers when they are due.

    Parameters
    ----------
    send : callable
        Sends a frame. It raises OSError where that fails: the next frame is tried again.
    """

    def __init__(self, send: Callable[[bytes], object]) -> None:
        self._send = send
        self._publishers: list[Publisher] = []
        self._changed = threading.Condition()
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="GOOSE publisher", daemon=True)
        self.failed = 0
        """Frames that could not be sent."""

    def start(self) -> None:
        """Begin to send."""
        self._thread.start()

    def stop(self) -> None:
        """Send nothing more."""
        with self._changed:
            self._stopping = True
            self._changed.notify()
        if self._thread.ident is not None:
            self._thread.join()

    def add(self, publisher: Publisher) -> None:
        """Publish a control block from now on.

        Parameters
        ----------
        publisher : Publisher
            Its publisher; only `change` may change it from now on.
        """
        with self._changed:
            self._publishers.append(publisher)
            self._changed.notify()

    def change(self, publisher: Publisher, values: Sequence[Value], time_ns: int) -> None:
        """Begin a new state of a publisher. Any thread may call this.

        Parameters
        ----------
        publisher : Publisher
            One that was added.
        values : sequence of Value
            Values of its data set.
        time_ns : int
            When they became so [ns, UTC].
        """
        with self._changed:
            publisher.change(values, time_ns)
            self._changed.notify()

    def _run(self) -> None:
        with self._changed:
            while not self._stopping:
                now_s = time.monotonic()
                for publisher in self._publishers:
                    if publisher.due_s <= now_s:
                        self._try(publisher.next_frame(now_s))
                due_s = min((publisher.due_s for publisher in self._publishers), default=None)
                self._changed.wait(None if due_s is None else max(0.0, due_s - time.monotonic()))

    def _try(self, frame: bytes) -> None:
        try:
            self._send(frame)
        except OSError:
            self.failed += 1
