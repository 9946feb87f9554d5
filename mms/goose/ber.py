"""Elements of the basic encoding rules as GOOSE uses them: tags of one octet, definite lengths."""

from collections.abc import Iterator

from mms.goose.errors import GooseFrameError

_LONGEST_LENGTH = 4
_LONG_FORM = 0x80
_MANY_OCTETS = 0x1F


def element(tag: int, content: bytes) -> bytes:
    """Encode an element.

    Parameters
    ----------
    tag : int
        Its tag, one octet.
    content : bytes
        Its content.

    Returns
    -------
    bytes
        The element.
    """
    size = len(content)
    if size < _LONG_FORM:
        return bytes([tag, size]) + content
    octets = size.to_bytes((size.bit_length() + 7) // 8, "big")
    return bytes([tag, _LONG_FORM | len(octets)]) + octets + content


def elements(octets: bytes, place: str) -> Iterator[tuple[int, bytes]]:
    """Split octets into elements.

    Parameters
    ----------
    octets : bytes
        Elements, one after the other.
    place : str
        What they are, for an error.

    Yields
    ------
    tuple of int and bytes
        Tag and content of each.

    Raises
    ------
    GooseFrameError
        They are no elements.
    """
    begin, end = 0, len(octets)
    while begin < end:
        tag = octets[begin]
        if tag & _MANY_OCTETS == _MANY_OCTETS:
            raise GooseFrameError(place, "tags of one octet", f"tag 0x{tag:02x}")
        begin += 1
        if begin == end:
            raise GooseFrameError(place, "a length behind the tag", "the end")
        size = octets[begin]
        begin += 1
        if size & _LONG_FORM:
            count = size & ~_LONG_FORM
            if not 0 < count <= _LONGEST_LENGTH or begin + count > end:
                raise GooseFrameError(place, "a definite length", f"0x{size:02x}")
            size = int.from_bytes(octets[begin : begin + count], "big")
            begin += count
        if size > end - begin:
            raise GooseFrameError(place, f"at most {end - begin} octets of content", f"{size}")
        yield tag, octets[begin : begin + size]
        begin += size


def unsigned(content: bytes, place: str) -> int:
    """Decode an INT32U. Its encoding may be longer than needed, as that with fixed offsets is.

    Parameters
    ----------
    content : bytes
        Content of the element.
    place : str
        The field, for an error.

    Returns
    -------
    int
        The number, 0 to 4294967295.

    Raises
    ------
    GooseFrameError
        It is no INT32U.
    """
    if not 0 < len(content) <= 5 or (len(content) == 5 and content[0]):
        raise GooseFrameError(place, "an integer of 32 bits without sign", f"{len(content)} octets")
    # Some publishers leave out the leading zero of numbers above 2**31 - 1; none of the fields is negative.
    return int.from_bytes(content, "big")


def integer(number: int) -> bytes:
    """Encode an integer as short as it goes.

    Parameters
    ----------
    number : int
        The number.

    Returns
    -------
    bytes
        Content of the element, with sign.
    """
    return number.to_bytes(
        number.bit_length() // 8 + 1 if number >= 0 else (~number).bit_length() // 8 + 1, "big", signed=True
    )
