"""Changing MMS messages on their way: file names, listings, report identifiers (ISO 9506-2)."""

from collections.abc import Mapping
from dataclasses import dataclass

from ied_sim.front.ber import Element, MalformedError, decode, encode
from ied_sim.misbehaviour import Kind, Switchboard
from ied_sim.profile import Files

_SESSION = bytes([1, 0, 1, 0])
"""Give tokens and data transfer (ISO 8327-1), before every message of an association."""

_CONFIRMED_REQUEST, _CONFIRMED_RESPONSE, _UNCONFIRMED = b"\xa0", b"\xa1", b"\xa3"
_FILE_OPEN, _FILE_READ, _FILE_DIRECTORY = b"\xbf\x48", b"\xbf\x49", b"\xbf\x4d"
_FIRST, _SECOND, _NAME = b"\xa0", b"\xa1", b"\x19"
_SIMPLE_FIRST, _SIMPLE_SECOND = b"\x80", b"\x81"
_SEQUENCE, _VISIBLE_STRING = b"\x30", b"\x8a"
_READ, _STRUCTURE, _BOOLEAN = b"\xa4", b"\xa2", b"\x83"
_FIELDS_OF_A_CONTROL_BLOCK = 11


@dataclass(frozen=True, slots=True)
class Rewritten:
    """The message to pass on; `file_bytes`: how much of a file it carries."""

    user_data: bytes
    file_bytes: int = 0


class Rewriter:
    """Rewrites the messages of one association, as the profile's files and the switchboard want it.

    report_ids: by RptID, the reference of the report control block, "R1CFG/LLN0$BR$BRep01".
    """

    def __init__(self, files: Files | None, switchboard: Switchboard, report_ids: Mapping[str, str]) -> None:
        self._report_ids = report_ids
        self._files = files
        self._switchboard = switchboard
        # A block's RptID stands while it is enabled: for an association it is what it was at its beginning.
        self._empties_report_ids = switchboard.is_on(Kind.EMPTY_RPTID)
        self._directory = ""

    def request(self, user_data: bytes) -> bytes:
        """A client's message, file names made those the server knows."""
        opened = _opened(user_data)
        if opened is None or opened[1].tag != _CONFIRMED_REQUEST:
            return user_data
        whole, pdu = opened
        service = pdu.parts[-1] if pdu.parts else Element(b"")
        if service.tag == _FILE_DIRECTORY:
            given = service.part(_FIRST)
            self._directory = "" if given is None else _names(given)[0].strip("/\\").replace("\\", "/")
            for names in service.parts or ():
                self._rename(names, within=names.tag == _SECOND)
        elif service.tag == _FILE_OPEN:
            opened_name = service.part(_FIRST)
            if opened_name is not None:
                self._rename(opened_name, within=self._without_path)
        else:
            return user_data
        return _SESSION + encode(whole)

    def response(self, user_data: bytes) -> Rewritten:
        """A server's message."""
        opened = _opened(user_data)
        if opened is None:
            return Rewritten(user_data)
        whole, pdu = opened
        service = pdu.parts[-1] if pdu.parts else Element(b"")
        if pdu.tag == _CONFIRMED_RESPONSE and service.tag == _FILE_READ:
            data = service.part(_SIMPLE_FIRST)
            return Rewritten(user_data, 0 if data is None else len(data.content))
        if pdu.tag == _CONFIRMED_RESPONSE and service.tag == _FILE_DIRECTORY:
            self._rewrite_listing(service)
        elif not self._empties_report_ids:
            return Rewritten(user_data)
        elif pdu.tag == _UNCONFIRMED:
            self._name_after_block(service)
        elif pdu.tag == _CONFIRMED_RESPONSE and service.tag == _READ:
            _empty_report_ids(service)
        else:
            return Rewritten(user_data)
        return Rewritten(_SESSION + encode(whole))

    def _name_after_block(self, report: Element) -> None:
        """A report of a block without RptID has the block's reference in its place, its first value."""
        values = report.part(_FIRST)
        if values is not None and values.parts and values.parts[0].tag == _VISIBLE_STRING:
            own = values.parts[0].content.decode("latin-1")
            values.parts[0].content = self._report_ids.get(own, own).encode("latin-1")

    @property
    def _without_path(self) -> bool:
        if self._switchboard.is_on(Kind.NAMES_WITHOUT_PATH):
            return True
        if self._switchboard.is_on(Kind.NAMES_WITH_PATH):
            return False
        return self._files is not None and self._files.listed == "name"

    def _rename(self, names: Element, *, within: bool) -> None:
        """A name from a client; `within` the folder last listed where it has none of its own."""
        for part in names.parts or ():
            name = part.content.replace(b"\\", b"/")
            if within and self._directory and b"/" not in name:
                name = self._directory.encode("latin-1") + b"/" + name
            part.content = name

    def _rewrite_listing(self, service: Element) -> None:
        entries = _entries(service)
        if entries.parts is None:
            return
        most = self._switchboard.number(Kind.PARTIAL_LISTING)
        if most is None and self._files is not None:
            most = self._files.entries_per_listing
        if most is not None and len(entries.parts) > most:
            del entries.parts[int(most) :]
            service.parts = [part for part in service.parts or () if part.tag != _SIMPLE_SECOND]
            service.parts.append(Element(_SIMPLE_SECOND, b"\xff"))
        by_bytes = self._switchboard.number(Kind.WRONG_SIZE)
        for entry in entries.parts:
            self._show_names(entry)
            if by_bytes is not None:
                _change_size(entry, int(by_bytes))

    def _show_names(self, entry: Element) -> None:
        separator = b"/" if self._files is None else self._files.separator.encode()
        names = entry.part(_FIRST)
        for part in (names.parts or ()) if names is not None else ():
            name = part.content.rpartition(b"/")[2] if self._without_path else part.content
            part.content = name.replace(b"/", separator)


def _opened(user_data: bytes) -> tuple[Element, Element] | None:
    """The presentation's element and the MMS PDU in it; None for what is no data of an association."""
    if not user_data.startswith(_SESSION):
        return None
    try:
        whole = decode(user_data[len(_SESSION) :])
    except MalformedError:
        return None
    value = whole.parts[0].part(_FIRST) if whole.parts else None
    if value is None or not value.parts:
        return None
    return whole, value.parts[0]


def _names(names: Element) -> list[str]:
    return [part.content.decode("latin-1") for part in names.parts or ()] or [""]


def _entries(service: Element) -> Element:
    """The SEQUENCE OF DirectoryEntry, which the [0] around it holds explicitly."""
    listed = service.part(_FIRST)
    if listed is None:
        return Element(_FIRST)
    inner = listed.part(_SEQUENCE)
    if inner is not None and inner.parts and inner.parts[0].tag == _SEQUENCE:
        return inner
    return listed


def _change_size(entry: Element, by_bytes: int) -> None:
    attributes = entry.part(_SECOND)
    size = None if attributes is None else attributes.part(_SIMPLE_FIRST)
    if size is not None:
        changed = max(0, int.from_bytes(size.content, "big") + by_bytes)
        size.content = changed.to_bytes(changed.bit_length() // 8 + 1, "big")


def _empty_report_ids(read: Element) -> None:
    """Of the control blocks among the values read: structures that begin with RptID and RptEna (or Resv)."""
    results = read.part(_SECOND)
    for value in (results.parts or ()) if results is not None else ():
        parts = value.parts or []
        tags = [part.tag for part in parts]
        if (
            value.tag == _STRUCTURE
            and len(parts) >= _FIELDS_OF_A_CONTROL_BLOCK
            and tags[:2] == [_VISIBLE_STRING, _BOOLEAN]
        ):
            parts[0].content = b""
