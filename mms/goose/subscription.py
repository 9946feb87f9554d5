"""What a subscriber makes of the messages of one control block (IEC 61850-8-1 clause 18; IEC 62351-6).

A message counts if it is of the block as configured and tells the same state again, or a later one. States
count up (stNum), and so do the tellings of a state (sqNum); both go on with 1 after 4294967295. What tells
an earlier state is a replay, as long as the publisher is alive. Where its time has run out, it may have begun
anew with lower numbers: then any state is taken, as a first one.
"""

from dataclasses import dataclass
from enum import Enum

from mms.goose.frame import GooseFrame
from mms.goose.message import HIGHEST_NUMBER, GooseMessage

LONGEST_LIFE_S = 600.0
"""A publisher that promises no message for longer is taken for silent after this."""


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
    """

    reference: str
    data_set: str
    goose_id: str
    configuration_revision: int
    entries: int
    destination: bytes
    application_id: int


class Reception(Enum):
    """What was made of a frame. The first four count, the others are ignored."""

    FIRST = "first state"
    CHANGED = "later state"
    REPEATED = "same state again"
    RESUMED = "first state after silence"
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


_COUNTING = {Reception.FIRST, Reception.CHANGED, Reception.REPEATED, Reception.RESUMED}


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
        if not made.counts:
            self.ignored[made] = self.ignored.get(made, 0) + 1
            return made
        if made is Reception.CHANGED and self.latest is not None:
            self.missed_states += ahead(self.latest.state_number, frame.message.state_number) - 1
        self.latest = frame.message
        self._ends_s = now_s + min(frame.message.time_allowed_to_live_ms / 1000, LONGEST_LIFE_S)
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
        if self._ends_s is None or now_s <= self._ends_s:
            return False
        self._ends_s = None
        self.lost += 1
        return True

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
            is_same = (message.time, message.values) == (latest.time, latest.values)
            return Reception.REPEATED if is_same else Reception.CONTRADICTORY
        if ahead(latest.state_number, message.state_number) <= 0:
            return Reception.REPLAYED
        return Reception.CHANGED


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
