"""Answers that are well-formed and lie: names, sizes, listings and files without end."""

from random import Random

from tests.hostile.dialogue import tlv

FILE_OPEN, FILE_READ, FILE_CLOSE, FILE_DIRECTORY = b"\xbf\x48", b"\x9f\x49", b"\x9f\x4a", b"\xbf\x4d"
NAMES = (
    *(b"../../x.CFG", b"../../../../../../etc/passwd", b"/etc/passwd", b"/x.DAT", b"..\\..\\x.DAT"),
    *(
        b"C:\\x.CFG",
        b"EVENTS/../../x.CFG",
        b"incoming/../../x.DAT",
        b"HR\x00.CFG",
        b"\x00",
        b"",
        b".",
        b"..",
        b"/",
    ),
    *(b"EVENTS/", b".CFG", b"HR_\xff\xfe.DAT", b"HR_1\n.CFG", b"HR_1\x1b[2J.CFG", b"A" * 10_000 + b".CFG"),
    *(b"%s%n%s.CFG", b"HR_10001.CFG", b"HR_10001.DAT", b"EVENTS/HR_10001.CFG"),
)
SIZES = (
    *(b"", b"\x00", b"\x01", b"\xff", b"\x7f\xff\xff\xff", b"\x80\x00\x00\x00", b"\x00\xff\xff\xff\xff"),
    *(b"\x00" * 9, b"\x7f" + b"\xff" * 7, b"\x00\x86\xa0"),
)
TIMES = (b"20261121060000Z", b"20261121060000.123Z", b"", b"9" * 15, b"-" * 15, b"\xff" * 15, b"2" * 5000)
ENTRIES_A_LISTING = 200


def attributes(chance: Random) -> bytes:
    """FileAttributes of ISO 9506-2: size, time of the last change."""
    return tlv(0x80, chance.choice(SIZES)) + tlv(0x81, chance.choice(TIMES))


def listing(chance: Random) -> bytes:
    """Entries with nasty names and sizes; some say that more follows, and so it goes on for ever."""
    entries = b"".join(
        tlv(0x30, tlv(0xA0, tlv(0x19, _name(chance))) + tlv(0xA1, attributes(chance)))
        for _ in range(chance.choice((0, 1, 5, ENTRIES_A_LISTING)))
    )
    more = tlv(0x81, b"\xff") if chance.random() < 0.5 else b""
    return _service(FILE_DIRECTORY, tlv(0xA0, tlv(0x30, entries)) + more)


def _name(chance: Random) -> bytes:
    """Half of them are new each time: a million files."""
    if chance.random() < 0.5:
        return b"EVENTS/HR_%09d.%s" % (chance.randrange(10**9), chance.choice((b"CFG", b"DAT", b"CEV")))
    return chance.choice(NAMES)


def opened(chance: Random) -> bytes:
    """A file of any size."""
    return _service(FILE_OPEN, tlv(0x80, chance.choice(SIZES)) + tlv(0xA1, attributes(chance)))


def part(chance: Random) -> bytes:
    """A part of a file that has no end, or an empty one."""
    more = b"" if chance.random() < 0.2 else tlv(0x81, chance.choice((b"\xff", b"\x00", b"")))
    return _service(b"\xbf\x49", tlv(0x80, bytes(chance.choice((0, 1, 1000, 60_000)))) + more)


def _service(tag: bytes, content: bytes) -> bytes:
    return tag + tlv(0x30, content)[1:]


ANSWERS = {FILE_DIRECTORY: listing, FILE_OPEN: opened, FILE_READ: part}
