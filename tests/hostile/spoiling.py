"""Spoiling good answers: bytes, BER elements, frames. Every function takes a seeded generator of chances."""

from collections.abc import Callable
from random import Random

from ied_sim.front.ber import Element, MalformedError, decode, encode

LENGTHS = (
    *(b"\x00", b"\x7f", b"\x80", b"\x81\xff", b"\x82\xff\xff", b"\x83\x7f\xff\xff", b"\x84\x7f\xff\xff\xff"),
    *(b"\x84\x80\x00\x00\x00", b"\x84\xff\xff\xff\xff", b"\x88" + b"\xff" * 8, b"\xff"),
)
NUMBERS = (
    b"",
    b"\x00",
    b"\xff",
    b"\x7f\xff\xff\xff",
    b"\x80\x00\x00\x00",
    b"\x00\xff\xff\xff\xff",
    b"\xff" * 9,
)
NASTY = (b"\x00", b"\xff", b"\x7f", b"\x80", b"\x01")
DEEPEST = 3000
LONG = 10_000

Spoiler = Callable[[Random, bytes], bytes]


def flipped(chance: Random, octets: bytes) -> bytes:
    """A few bits are other ones."""
    spoilt = bytearray(octets)
    for _ in range(chance.randint(1, 8)):
        spoilt[chance.randrange(len(spoilt))] ^= 1 << chance.randrange(8)
    return bytes(spoilt)


def overwritten(chance: Random, octets: bytes) -> bytes:
    spoilt = bytearray(octets)
    for _ in range(chance.randint(1, 4)):
        place = chance.randrange(len(spoilt))
        spoilt[place : place + 1] = chance.choice(NASTY)
    return bytes(spoilt)


def truncated(chance: Random, octets: bytes) -> bytes:
    return octets[: chance.randrange(len(octets))]


def extended(chance: Random, octets: bytes) -> bytes:
    return octets + chance.randbytes(chance.choice((1, 7, 300, LONG)))


def run_repeated(chance: Random, octets: bytes) -> bytes:
    begin = chance.randrange(len(octets))
    run = octets[begin : begin + chance.randint(1, 40)]
    return octets[:begin] + run * chance.choice((2, 3, 50)) + octets[begin:]


def run_removed(chance: Random, octets: bytes) -> bytes:
    begin = chance.randrange(len(octets))
    return octets[:begin] + octets[begin + chance.randint(1, 20) :]


def _element(chance: Random, octets: bytes, changed: Callable[[Random, Element], bytes]) -> bytes:
    """One element of a message replaced; lengths around it are right."""
    try:
        whole = decode(octets)
    except MalformedError:
        return flipped(chance, octets)
    elements = [whole]
    for element in elements:
        elements.extend(element.parts or ())
    chosen = chance.choice(elements)

    def built(element: Element) -> bytes:
        if element is chosen:
            return changed(chance, element)
        if element.parts is None:
            return encode(element)
        return encode(Element(element.tag, b"".join(map(built, element.parts))))

    return built(whole)


def _content(element: Element) -> bytes:
    return element.content if element.parts is None else b"".join(map(encode, element.parts))


def wrong_length(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda c, e: e.tag + c.choice(LENGTHS) + _content(e))


def wrong_number(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda c, e: encode(Element(e.tag, c.choice(NUMBERS))))


def wrong_tag(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda c, e: encode(Element(c.randbytes(1), _content(e))))


def long_content(chance: Random, octets: bytes) -> bytes:
    return _element(
        chance, octets, lambda c, e: encode(Element(e.tag, c.choice((b"A", b"../", b"%n")) * LONG))
    )


def emptied(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda _c, e: encode(Element(e.tag)))


def removed(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda _c, _e: b"")


def multiplied(chance: Random, octets: bytes) -> bytes:
    return _element(chance, octets, lambda c, e: encode(e) * c.choice((2, 3, 200)))


def nested(chance: Random, octets: bytes) -> bytes:
    """An element within itself, deeper than any message needs."""

    def deep(chance: Random, element: Element) -> bytes:
        inner = encode(element)
        tag = chance.choice((b"\x30", b"\xa2", b"\xa1", bytes([element.tag[0] | 0x20])))
        for _ in range(chance.choice((60, 400, DEEPEST))):
            inner = encode(Element(tag, inner))
        return inner

    return _element(chance, octets, deep)


OF_FRAMES: tuple[Spoiler, ...] = (flipped, overwritten, truncated, extended, run_repeated, run_removed)
OF_MESSAGES: tuple[Spoiler, ...] = (
    *OF_FRAMES,
    *(wrong_length, wrong_number, wrong_tag, long_content, emptied, removed, multiplied, nested),
)
