"""Basic encoding rules as MMS uses them (ISO/IEC 8825-1): definite lengths, tags of up to two octets."""

from collections.abc import Iterator
from dataclasses import dataclass

_DEEPEST = 50


class MalformedError(ValueError):
    """The octets are no BER element."""


@dataclass(slots=True)
class Element:
    """One element: its tag, and either its `content` or, if it is constructed, its `parts`."""

    tag: bytes
    content: bytes = b""
    parts: "list[Element] | None" = None

    def part(self, tag: bytes) -> "Element | None":
        """Return the first part with this tag, None where there is none."""
        return next((part for part in self.parts or () if part.tag == tag), None)


def decode(octets: bytes) -> Element:
    """Decode octets that are one element. Raise MalformedError where they are not."""
    found = list(_elements(octets, 0, len(octets), 0))
    if len(found) != 1:
        raise MalformedError(f"{len(found)} elements where one was expected")
    return found[0]


def encode(whole: Element) -> bytes:
    """Encode an element with its parts."""
    return element(whole.tag, whole.content if whole.parts is None else b"".join(map(encode, whole.parts)))


def element(tag: bytes, content: bytes) -> bytes:
    """Encode a tag, its length and its content."""
    return tag + _length(len(content)) + content


def spans(octets: bytes, begin: int, end: int) -> Iterator[tuple[bytes, int, int, int]]:
    """Yield the elements in octets[begin:end] without decoding their contents.

    Each is told by its tag, and by where it, its content and the next element begin. Raises MalformedError.
    """
    place = begin
    while place < end:
        begin = place
        place += 1
        if octets[begin] & 0x1F == 0x1F:
            place += 1
        tag = octets[begin:place]
        if place >= end:
            raise MalformedError("an element without a length")
        length = octets[place]
        place += 1
        if length & 0x80:
            count = length & 0x7F
            length = int.from_bytes(octets[place : place + count], "big")
            place += count
        content = place
        place += length
        if place > end:
            raise MalformedError("an element longer than what holds it")
        yield tag, begin, content, place


def _elements(octets: bytes, begin: int, end: int, depth: int) -> Iterator[Element]:
    if depth > _DEEPEST:
        raise MalformedError(f"elements nested over {_DEEPEST} deep")
    for tag, _, content, following in spans(octets, begin, end):
        if tag[0] & 0x20:
            yield Element(tag, parts=list(_elements(octets, content, following, depth + 1)))
        else:
            yield Element(tag, octets[content:following])


def _length(length: int) -> bytes:
    if length < 0x80:
        return bytes([length])
    octets = length.to_bytes((length.bit_length() + 7) // 8, "big")
    return bytes([0x80 | len(octets)]) + octets
