"""Messages of a client that is right but for one of them: what hypothesis makes of a good session."""

from collections.abc import Callable
from dataclasses import dataclass

from hypothesis import given, settings
from hypothesis import strategies as st


@dataclass(frozen=True, slots=True)
class Spoiling:
    """What becomes of one message of a session.

    message: which one.  changes: places, as parts of its length, and the octets they get.  kept: the part
    of it that is sent.  added: octets behind it.
    """

    message: int
    changes: tuple[tuple[float, int], ...]
    kept: float
    added: bytes

    def of(self, number: int, content: bytes) -> bytes:
        """Return what is sent as message `number` instead of this content."""
        if number != self.message:
            return content
        spoiled = bytearray(content)
        for place, octet in self.changes:
            spoiled[int(place * len(spoiled))] = octet
        return bytes(spoiled[: round(self.kept * len(spoiled))]) + self.added


_PLACES = st.floats(0, 1, exclude_max=True)
_CHANGES = st.lists(st.tuples(_PLACES, st.integers(0, 255)), min_size=1, max_size=6).map(tuple)


def spoilings(messages: int) -> st.SearchStrategy[Spoiling]:
    """Return spoilings of one of so many messages; most leave its length as it is."""
    return st.builds(
        Spoiling,
        message=st.integers(0, messages - 1),
        changes=_CHANGES,
        kept=st.one_of(st.just(1.0), st.just(1.0), st.floats(0, 1)),
        added=st.one_of(st.just(b""), st.just(b""), st.binary(max_size=40)),
    )


def try_spoilings(messages: int, session: Callable[[Spoiling], None], *, examples: int) -> None:
    """Hold sessions of so many messages with one of them spoiled. Raises what `session` raises."""

    @settings(max_examples=examples, deadline=None)
    @given(spoilings(messages))
    def every_one(spoiling: Spoiling) -> None:
        session(spoiling)

    every_one()
