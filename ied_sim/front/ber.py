"""Basic encoding rules as MMS uses them (ISO/IEC 8825-1): definite lengths, tags of up to two octets."""

from collections.abc import Iterator
from dataclasses import dataclass

_DEEPEST = 50


class MalformedError(ValueError):
    """Octets that are no BER element."""


@dataclass(slots=True)
class Element:
    """One element: its tag, and either its `content` or, if it is constructed, its `parts`."""

    tag: bytes
    content: bytes = b""
    parts: "list[Element] | None" = None

    def part(self, tag: bytes) -> "Element | None":
        """The first part with this tag."""
        return next((part for part in self.parts or () if part.tag == tag), None)


def decode(octets: bytes) -> Element:
    """The one element that `octets` are. Raises MalformedError."""
    elements = list(_elements(octets, 0))
    if len(elements) != 1:
        raise MalformedError(f"{len(elements)} elements where one was expected")
    return elements[0]


def encode(element: Element) -> bytes:
    content = element.content if element.parts is None else b"".join(map(encode, element.parts))
    return element.tag + _length(len(content)) + content


def _elements(octets: bytes, depth: int) -> Iterator[Element]:
    if depth > _DEEPEST:
        raise MalformedError(f"elements nested over {_DEEPEST} deep")
    place = 0
    while place < len(octets):
        begin = place
        place += 1
        if octets[begin] & 0x1F == 0x1F:
            place += 1
        tag = octets[begin:place]
        if place >= len(octets):
            raise MalformedError("an element without a length")
        length = octets[place]
        place += 1
        if length & 0x80:
            count = length & 0x7F
            length = int.from_bytes(octets[place : place + count], "big")
            place += count
        content = octets[place : place + length]
        if len(content) != length:
            raise MalformedError("an element longer than what holds it")
        place += length
        if tag[0] & 0x20:
            yield Element(tag, parts=list(_elements(content, depth + 1)))
        else:
            yield Element(tag, content)


def _length(length: int) -> bytes:
    if length < 0x80:
        return bytes([length])
    octets = length.to_bytes((length.bit_length() + 7) // 8, "big")
    return bytes([0x80 | len(octets)]) + octets
