"""What GOOSE messages tell of the plant: signals that rise and fall. It knows no socket and no database."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import structlog

from mms.goose import GooseFrame, GooseFrameError, Reception, Subscription, decode_frame
from service.gateways.goose.signals import Meaning, Signal, WatchedBlock

log = structlog.get_logger(__name__)

MOST_NAMED = 3


@dataclass(frozen=True, slots=True)
class SignalChange:
    """A signal is on or off, since `time_ns` by its sender's clock."""

    signal: Signal
    is_on: bool
    time_ns: int


@dataclass(slots=True)
class _Watched:
    block: WatchedBlock
    subscription: Subscription
    values: dict[Signal, bool] = field(default_factory=dict)
    """The latest value of each signal that could be used."""


class GooseListener:
    """Takes frames, and tells which signals changed."""

    def __init__(self, blocks: Sequence[WatchedBlock], *, simulated: bool = False) -> None:
        self._watched = {
            block.subscribed.reference: _Watched(
                block, Subscription(block.subscribed, accept_simulated=simulated)
            )
            for block in blocks
        }
        self._has_refused = False

    def receive(self, octets: bytes, now_s: float) -> list[SignalChange]:
        """Return what a frame changed. now_s: of a steady clock."""
        try:
            frame = decode_frame(octets)
        except GooseFrameError as error:
            if not self._has_refused:
                self._has_refused = True
                log.warning("a GOOSE frame is refused; further ones are not told", reason=str(error))
            return []
        watched = self._watched.get(frame.message.control_block)
        return [] if watched is None else list(self._taken(watched, frame, now_s))

    def expire(self, now_s: float) -> None:
        """See which senders have fallen silent."""
        for reference, watched in self._watched.items():
            if watched.subscription.expire(now_s):
                log.warning("a GOOSE control block has fallen silent", block=reference)

    @property
    def problem(self) -> str | None:
        """Return which control blocks are not heard as they are configured; None where all are."""
        silent = [
            f"{reference}{_ignored(watched.subscription)}"
            for reference, watched in self._watched.items()
            if not watched.subscription.is_alive
        ]
        if not silent:
            return None
        named = ", ".join(silent[:MOST_NAMED])
        more = f" and {len(silent) - MOST_NAMED} more" if len(silent) > MOST_NAMED else ""
        return f"{len(silent)} of {len(self._watched)} GOOSE control blocks are not heard: {named}{more}"

    def _taken(self, watched: _Watched, frame: GooseFrame, now_s: float) -> Iterator[SignalChange]:
        missed = watched.subscription.missed_states
        made = watched.subscription.receive(frame, now_s)
        if not made.counts:
            if watched.subscription.ignored[made] == 1:
                log.warning("a GOOSE message is ignored", block=frame.message.control_block, why=made.value)
            return
        if made is Reception.REPEATED:
            return
        missed = watched.subscription.missed_states - missed
        if missed:
            log.warning("GOOSE states were missed", block=frame.message.control_block, states=missed)
        for signal in watched.block.signals:
            is_on = signal.value(frame.message.values)
            if is_on is None or watched.values.get(signal) is is_on:
                continue
            is_first = signal not in watched.values
            watched.values[signal] = is_on
            # A trip may have been told before this one listened. What asks for a record is over by then.
            if is_first and signal.meaning is Meaning.TRIGGER and not _is_new(frame):
                continue
            yield SignalChange(signal, is_on, frame.message.time.ns)


def _is_new(frame: GooseFrame) -> bool:
    """Tell whether a message is the first one of its state."""
    return frame.message.sequence_number == 0


def _ignored(subscription: Subscription) -> str:
    """Return why messages of a block were ignored, the most frequent reason."""
    if not subscription.ignored:
        return ""
    reason = max(subscription.ignored, key=lambda one: subscription.ignored[one])
    return f" ({reason.value})"
