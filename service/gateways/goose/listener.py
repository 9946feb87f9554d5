"""What GOOSE messages tell of the plant: signals that rise and fall. It knows no socket and no database."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import structlog

from mms.goose import GooseFrame, GooseFrameError, Reception, Subscription, decode_frame
from service.gateways.goose.signals import Meaning, Signal, WatchedBlock

log = structlog.get_logger(__name__)

MOST_NAMED = 3
MISSED_S = 60.0
"""Missed states of a control block are told so often at most: whoever makes them up writes no log."""


@dataclass(frozen=True, slots=True)
class SignalChange:
    """A signal is on or off, since `time_ns` by its sender's clock. block: reference of what sends it."""

    block: str
    signal: Signal
    is_on: bool
    time_ns: int


@dataclass(slots=True)
class _Watched:
    block: WatchedBlock
    subscription: Subscription
    values: dict[Signal, bool] = field(default_factory=dict)
    """The latest value of each signal that could be used."""
    missed_told: int = 0
    missed_told_s: float | None = None
    """When missed states were logged last; None for never."""


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
        silent, disputed = [], []
        for reference, watched in self._watched.items():
            if not watched.subscription.is_alive:
                silent.append(f"{reference}{_ignored(watched.subscription)}")
            elif watched.subscription.is_disputed:
                disputed.append(reference)
        count = len(self._watched)
        problems = []
        if silent:
            problems.append(f"{len(silent)} of {count} GOOSE control blocks are not heard: {named(silent)}")
        if disputed:
            problems.append(
                f"{len(disputed)} of {count} GOOSE control blocks are told in two states at once, and one of "
                f"them is ignored as a replay: {named(disputed)}"
            )
        return "; ".join(problems) or None

    def _taken(self, watched: _Watched, frame: GooseFrame, now_s: float) -> Iterator[SignalChange]:
        made = watched.subscription.receive(frame, now_s)
        if not made.counts:
            if watched.subscription.ignored[made] == 1:
                log.warning("a GOOSE message is ignored", block=frame.message.control_block, why=made.value)
            return
        if made is Reception.REPEATED:
            return
        _tell_missed(watched, now_s)
        if made is Reception.BEGUN_ANEW:
            log.warning(
                "a GOOSE control block is told in two states at once", block=frame.message.control_block
            )
        for signal in watched.block.signals:
            is_on = signal.value(frame.message.values)
            if is_on is None or watched.values.get(signal) is is_on:
                continue
            is_first = signal not in watched.values
            watched.values[signal] = is_on
            # A trip may have been told before this one listened. What asks for a record is over by then.
            if is_first and signal.meaning is Meaning.TRIGGER and not _is_new(frame):
                continue
            yield SignalChange(frame.message.control_block, signal, is_on, frame.message.time.ns)


def named(references: Sequence[str]) -> str:
    """Return the first few, and how many more there are."""
    more = f" and {len(references) - MOST_NAMED} more" if len(references) > MOST_NAMED else ""
    return ", ".join(references[:MOST_NAMED]) + more


def _tell_missed(watched: _Watched, now_s: float) -> None:
    """Log how many states were missed since that was logged last, if that is long enough ago."""
    missed = watched.subscription.missed_states - watched.missed_told
    if missed and (watched.missed_told_s is None or now_s - watched.missed_told_s >= MISSED_S):
        log.warning("GOOSE states were missed", block=watched.block.subscribed.reference, states=missed)
        watched.missed_told, watched.missed_told_s = watched.subscription.missed_states, now_s


def _is_new(frame: GooseFrame) -> bool:
    """Tell whether a message is the first one of its state."""
    return frame.message.sequence_number == 0


def _ignored(subscription: Subscription) -> str:
    """Return why messages of a block were ignored, the most frequent reason."""
    if not subscription.ignored:
        return ""
    reason = max(subscription.ignored, key=lambda one: subscription.ignored[one])
    return f" ({reason.value})"
