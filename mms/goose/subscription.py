"""What a subscriber makes of the messages of one control block (IEC 61850-8-1 clause 18; IEC 62351-6).

A message counts if it is of the block as configured and tells the same state again, or a later one. States
count up (stNum), and so do the tellings of a state (sqNum); both go on with 1 after 4294967295. What tells
an earlier state is a replay, as long as the publisher is alive. Where its time has run out, it may have begun
anew with lower numbers: then any state is taken, as a first one.

Nothing is signed, so a forged state far ahead makes replays of all that the publisher tells. No state lives
for longer than its block's configuration allows (`SubscribedBlock.longest_life_s`). Where somebody keeps it
alive, what is ignored is followed too: other states that are told for longer than that, in order, count.
"""

from dataclasses import dataclass
from enum import Enum

from mms.goose.frame import GooseFrame
from mms.goose.message import HIGHEST_NUMBER, GooseMessage

MAXIMUM_TIMES = 4
"""A state lives for so many of its block's longest intervals (MaxTime) at most; publishers promise 2 or 3."""
SHORTEST_CAP_S = 2.0
"""No state's life is capped to less: a busy network may be late."""
UNSAID_CAP_S = 60.0
"""It lives for so long at most where the configuration says nothing."""
LONGEST_CAP_S = 600.0
"""It lives for no longer than this, whatever the configuration says."""
DISPUTING = 2
"""So many messages of other states within a life are a dispute. One may be a frame that was late."""


@dataclass(frozen=True, slots=True)
class SubscribedBlock:
    """A control block as its publisher's SCL describes it.

    Parameters
    ----------
    reference : str
        Reference of the block, "A1_SEL710CFG/LLN0$GO$GPub01".
    data_set : str
        Reference of its data set, "A1_SEL710CFG/LLN0$DSet04".
    goose_id : str
        Identification of its messages.
    configuration_revision : int
        Revision of the data set.
    entries : int
        Members of the data set.
    destination : bytes
        Multicast address, six octets.
    application_id : int
        APPID.
    maximum_time_ms : int or None
        Longest interval between its messages [ms] (MaxTime); None or 0 where it is not said.
    """

    reference: str
    data_set: str
    goose_id: str
    configuration_revision: int
    entries: int
    destination: bytes
    application_id: int
    maximum_time_ms: int | None = None

    @property
    def longest_life_s(self) -> float:
        """So long a state lives at most [s], whatever its message allows."""
        if not self.maximum_time_ms:
            return UNSAID_CAP_S
        return min(max(MAXIMUM_TIMES * self.maximum_time_ms / 1000, SHORTEST_CAP_S), LONGEST_CAP_S)


class Reception(Enum):
    """What was made of a frame. The first five count, the others are ignored."""

    FIRST = "first state"
    CHANGED = "later state"
    REPEATED = "same state again"
    RESUMED = "first state after silence"
    BEGUN_ANEW = "a state that was told for long beside a later one"
    REPLAYED = "an earlier state or telling again"
    CONTRADICTORY = "another content of the same state"
    WRONG_ADDRESS = "another APPID or destination than configured"
    WRONG_REVISION = "another confRev than configured"
    WRONG_DATA_SET = "another data set, or identification, than configured"
    SIMULATED = "test or simulation bit is set"
    NEEDS_COMMISSIONING = "the publisher says that it is not commissioned"
    ENDLESS = "no time allowed to live"

    @property
    def counts(self) -> bool:
        """Whether the message is one of the subscribed block, and not an old one."""
        return self in _COUNTING


_COUNTING = {
    Reception.FIRST,
    Reception.CHANGED,
    Reception.REPEATED,
    Reception.RESUMED,
    Reception.BEGUN_ANEW,
}


@dataclass(slots=True)
class _Rival:
    """Messages that are ignored, though each goes on from the one before: the publisher may tell them."""

    latest: GooseMessage
    began_s: float
    latest_s: float


class Subscription:
    """State of one control block as a subscriber sees it.

    Parameters
    ----------
    block : SubscribedBlock
        The block as it is configured.
    accept_simulated : bool
        Whether messages of test sets count.
    """

    def __init__(self, block: SubscribedBlock, *, accept_simulated: bool = False) -> None:
        self.block = block
        self._accept_simulated = accept_simulated
        self._ends_s: float | None = None
        self._rival: _Rival | None = None
        self._disputed_s: list[float] = []
        """When the latest messages of other states were ignored."""
        self.latest: GooseMessage | None = None
        """The latest message that counted."""
        self.missed_states = 0
        """States that were told, or should have been, and never came."""
        self.lost = 0
        """How often the publisher fell silent."""
        self.ignored: dict[Reception, int] = {}
        """How many frames were ignored, by reason."""

    @property
    def is_alive(self) -> bool:
        """Whether the publisher has told its state within the time it allowed."""
        return self._ends_s is not None

    @property
    def is_disputed(self) -> bool:
        """Whether messages of the block tell another state than the one that counts, and are ignored."""
        return len(self._disputed_s) >= DISPUTING

    def receive(self, frame: GooseFrame, now_s: float) -> Reception:
        """Take a frame with the block's reference.

        Parameters
        ----------
        frame : GooseFrame
            The frame.
        now_s : float
            Time of a steady clock [s].

        Returns
        -------
        Reception
            What was made of it. `latest` is the message where it counts.
        """
        self.expire(now_s)
        made = self._mismatch(frame) or self._judged(frame.message)
        if made in (Reception.REPLAYED, Reception.CONTRADICTORY) and self._disputes(frame.message, now_s):
            made = Reception.BEGUN_ANEW
        if not made.counts:
            self.ignored[made] = self.ignored.get(made, 0) + 1
            return made
        if made is Reception.CHANGED and self.latest is not None:
            self.missed_states += ahead(self.latest.state_number, frame.message.state_number) - 1
        self.latest = frame.message
        allowed_s = frame.message.time_allowed_to_live_ms / 1000
        self._ends_s = now_s + min(allowed_s, self.block.longest_life_s)
        if made is not Reception.REPEATED and made is not Reception.CHANGED:
            self._rival = None
        return made

    def expire(self, now_s: float) -> bool:
        """See whether the publisher has fallen silent.

        Parameters
        ----------
        now_s : float
            Time of a steady clock [s].

        Returns
        -------
        bool
            True once, where its time has run out since it was last seen alive.
        """
        begins_s = now_s - self.block.longest_life_s
        self._disputed_s = [ignored_s for ignored_s in self._disputed_s if ignored_s >= begins_s]
        if self._rival is not None and self._rival.latest_s < begins_s:
            self._rival = None
        if self._ends_s is None or now_s <= self._ends_s:
            return False
        self._ends_s = None
        self.lost += 1
        return True

    def _disputes(self, message: GooseMessage, now_s: float) -> bool:
        """Take a message that is an old one or contradicts; tell whether it has been so for too long.

        A duplicate of the latest state, as redundant networks make them, tells nothing else than that.
        """
        if self.latest is not None and _tell_same(self.latest, message):
            return False
        self._disputed_s = [*self._disputed_s[1 - DISPUTING :], now_s]
        rival = self._rival
        if rival is None:
            self._rival = _Rival(message, now_s, now_s)
            return False
        if not _goes_on(rival.latest, message):
            return False
        rival.latest, rival.latest_s = message, now_s
        return now_s - rival.began_s > self.block.longest_life_s

    def _mismatch(self, frame: GooseFrame) -> Reception | None:
        """Return why a frame is not what the configuration says; None where it is."""
        block, message = self.block, frame.message
        found = {
            Reception.WRONG_ADDRESS: (frame.application_id, frame.destination)
            != (block.application_id, block.destination),
            Reception.SIMULATED: (frame.simulated or message.simulation) and not self._accept_simulated,
            Reception.NEEDS_COMMISSIONING: message.needs_commissioning,
            Reception.WRONG_REVISION: message.configuration_revision != block.configuration_revision,
            Reception.WRONG_DATA_SET: message.data_set != block.data_set
            or message.goose_id not in (None, block.goose_id)
            or len(message.values) != block.entries,
            Reception.ENDLESS: message.time_allowed_to_live_ms == 0,
        }
        return next((reason for reason, is_so in found.items() if is_so), None)

    def _judged(self, message: GooseMessage) -> Reception:
        latest = self.latest
        if latest is None:
            return Reception.FIRST
        if not self.is_alive:
            return Reception.RESUMED
        if message.state_number == latest.state_number:
            if ahead(latest.sequence_number, message.sequence_number) <= 0:
                return Reception.REPLAYED
            return Reception.REPEATED if _tell_same(latest, message) else Reception.CONTRADICTORY
        if ahead(latest.state_number, message.state_number) <= 0:
            return Reception.REPLAYED
        return Reception.CHANGED


def _tell_same(one: GooseMessage, other: GooseMessage) -> bool:
    """Tell whether two messages are tellings of one state."""
    return (one.state_number, one.time, one.values) == (other.state_number, other.time, other.values)


def _goes_on(before: GooseMessage, after: GooseMessage) -> bool:
    """Tell whether a message may be the publisher's next one after another: neither number falls."""
    if before.state_number != after.state_number:
        return ahead(before.state_number, after.state_number) > 0
    return _tell_same(before, after) and ahead(before.sequence_number, after.sequence_number) > 0


def ahead(before: int, after: int) -> int:
    """Tell how many steps a number is ahead of another one, where 1 follows 4294967295.

    Parameters
    ----------
    before : int
        A number of 32 bits.
    after : int
        A number of 32 bits.

    Returns
    -------
    int
        The steps; 0 or less where it is the same, or behind.
    """
    # 0 is left out on the way round.
    forward = after - before + (0 if after >= before else HIGHEST_NUMBER)
    return forward if forward <= HIGHEST_NUMBER // 2 else forward - HIGHEST_NUMBER


def following(number: int) -> int:
    """Return the number after this one.

    Parameters
    ----------
    number : int
        A number of 32 bits.

    Returns
    -------
    int
        The next one; 1 after the highest.
    """
    return 1 if number >= HIGHEST_NUMBER else number + 1
