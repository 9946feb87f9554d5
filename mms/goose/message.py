"""The message of a GOOSE frame (IEC 61850-8-1 annex A, IECGoosePdu)."""

from dataclasses import dataclass

from mms.goose.ber import element, elements, integer, unsigned
from mms.goose.data import decode_values, encode_values
from mms.goose.errors import GooseFrameError
from mms.values import Timestamp, Value

HIGHEST_NUMBER = 0xFFFFFFFF
LONGEST_NAME = 129

_PDU = 0x61
_FIELDS = {
    0x80: "gocbRef",
    0x81: "timeAllowedtoLive",
    0x82: "datSet",
    0x83: "goID",
    0x84: "t",
    0x85: "stNum",
    0x86: "sqNum",
    0x87: "simulation",
    0x88: "confRev",
    0x89: "ndsCom",
    0x8A: "numDatSetEntries",
    0xAB: "allData",
}
"""By tag, in the order in which they come."""
_MAY_LACK = {"goID", "simulation", "ndsCom"}


@dataclass(frozen=True, slots=True)
class GooseMessage:
    """A state of a data set, as it is told once or again.

    Parameters
    ----------
    control_block : str
        Reference of the control block, "A1_SEL710CFG/LLN0$GO$GPub01" (gocbRef).
    time_allowed_to_live_ms : int
        So long the message counts at most [ms]; before that the next one comes.
    data_set : str
        Reference of the data set, "A1_SEL710CFG/LLN0$DSet04".
    goose_id : str or None
        Identification of the message (goID); None where it has none.
    time : Timestamp
        When the state began (t).
    state_number : int
        Number of the state (stNum): another one for each change.
    sequence_number : int
        How often the state was told before (sqNum).
    simulation : bool
        The message is a test set's; "test" in edition 1.
    configuration_revision : int
        Revision of the data set (confRev).
    needs_commissioning : bool
        The publisher's configuration is not complete (ndsCom).
    values : tuple of Value
        Values of the data set, in its order.
    """

    control_block: str
    time_allowed_to_live_ms: int
    data_set: str
    goose_id: str | None
    time: Timestamp
    state_number: int
    sequence_number: int
    simulation: bool
    configuration_revision: int
    needs_commissioning: bool
    values: tuple[Value, ...]


def encode_message(message: GooseMessage) -> bytes:
    """Encode a message.

    Parameters
    ----------
    message : GooseMessage
        The message.

    Returns
    -------
    bytes
        The IECGoosePdu.

    Raises
    ------
    ValueError
        A field is beyond what GOOSE can carry.
    """
    contents = {
        "gocbRef": _encoded_name(message.control_block),
        "timeAllowedtoLive": _number(message.time_allowed_to_live_ms),
        "datSet": _encoded_name(message.data_set),
        "t": message.time.octets(),
        "stNum": _number(message.state_number),
        "sqNum": _number(message.sequence_number),
        "simulation": bytes([message.simulation]),
        "confRev": _number(message.configuration_revision),
        "ndsCom": bytes([message.needs_commissioning]),
        "numDatSetEntries": _number(len(message.values)),
        "allData": encode_values(message.values),
    }
    if message.goose_id is not None:
        contents["goID"] = _encoded_name(message.goose_id)
    fields = (element(tag, contents[name]) for tag, name in _FIELDS.items() if name in contents)
    return element(_PDU, b"".join(fields))


def decode_message(octets: bytes) -> GooseMessage:
    """Decode a message. Whatever the octets are, no other error comes of them than this one.

    Parameters
    ----------
    octets : bytes
        The IECGoosePdu, and nothing behind it.

    Returns
    -------
    GooseMessage
        The message.

    Raises
    ------
    GooseFrameError
        They are none.
    """
    pdus = list(elements(octets, "GOOSE message"))
    if [tag for tag, _ in pdus] != [_PDU]:
        raise GooseFrameError(
            "GOOSE message", "one element with tag 0x61", f"{[hex(tag) for tag, _ in pdus]}"
        )
    fields = _fields(pdus[0][1])
    values = decode_values(fields["allData"])
    count = unsigned(fields["numDatSetEntries"], "numDatSetEntries")
    if count != len(values):
        raise GooseFrameError("allData", f"{count} values, as numDatSetEntries says", f"{len(values)}")
    if len(fields["t"]) != 8:
        raise GooseFrameError("t", "8 octets", f"{len(fields['t'])}")
    return GooseMessage(
        control_block=_name(fields, "gocbRef"),
        time_allowed_to_live_ms=unsigned(fields["timeAllowedtoLive"], "timeAllowedtoLive"),
        data_set=_name(fields, "datSet"),
        goose_id=_name(fields, "goID") if "goID" in fields else None,
        time=Timestamp.of(fields["t"]),
        state_number=unsigned(fields["stNum"], "stNum"),
        sequence_number=unsigned(fields["sqNum"], "sqNum"),
        simulation=_flag(fields, "simulation"),
        configuration_revision=unsigned(fields["confRev"], "confRev"),
        needs_commissioning=_flag(fields, "ndsCom"),
        values=values,
    )


def _fields(octets: bytes) -> dict[str, bytes]:
    """Return the contents of the fields by name: each once, in order, none missing."""
    fields: dict[str, bytes] = {}
    last = 0
    for tag, content in elements(octets, "GOOSE message"):
        name = _FIELDS.get(tag)
        if name is None or tag <= last:
            raise GooseFrameError("GOOSE message", "the fields of IECGoosePdu in order", f"tag 0x{tag:02x}")
        fields[name] = content
        last = tag
    missing = [name for name in _FIELDS.values() if name not in fields and name not in _MAY_LACK]
    if missing:
        raise GooseFrameError("GOOSE message", f"the fields {', '.join(missing)}", "none")
    return fields


def _name(fields: dict[str, bytes], name: str) -> str:
    content = fields[name]
    if len(content) > LONGEST_NAME or not all(0x20 <= octet < 0x7F for octet in content):
        raise GooseFrameError(name, f"at most {LONGEST_NAME} printable ASCII letters", f"{content[:40]!r}")
    return content.decode("ascii")


def _flag(fields: dict[str, bytes], name: str) -> bool:
    content = fields.get(name, b"\x00")
    if len(content) != 1:
        raise GooseFrameError(name, "one octet", f"{len(content)}")
    return content != b"\x00"


def _encoded_name(name: str) -> bytes:
    if len(name) > LONGEST_NAME or not name.isascii() or not name.isprintable():
        raise ValueError(f"expected at most {LONGEST_NAME} printable ASCII letters, found {name[:40]!r}")
    return name.encode("ascii")


def _number(number: int) -> bytes:
    if not 0 <= number <= HIGHEST_NUMBER:
        raise ValueError(f"expected a number of 32 bits without sign, found {number}")
    return integer(number)
