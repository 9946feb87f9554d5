"""Changes to MMS messages that pass a proxy: file names, listings, report identifiers (ISO 9506-2)."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from ied_sim.front.ber import Element, MalformedError, decode, element, encode, spans
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.profiles.profile import Files

_SESSION = bytes([1, 0, 1, 0])
"""Give-tokens and data-transfer SPDU (ISO 8327-1), which precede every message of an association."""

_CONFIRMED_REQUEST, _CONFIRMED_RESPONSE, _UNCONFIRMED = b"\xa0", b"\xa1", b"\xa3"
_FILE_OPEN, _FILE_READ, _FILE_DIRECTORY = b"\xbf\x48", b"\xbf\x49", b"\xbf\x4d"
_FIRST, _SECOND, _NAME = b"\xa0", b"\xa1", b"\x19"
_SIMPLE_FIRST, _SIMPLE_SECOND = b"\x80", b"\x81"
_SEQUENCE, _VISIBLE_STRING = b"\x30", b"\x8a"
_READ, _STRUCTURE, _BOOLEAN = b"\xa4", b"\xa2", b"\x83"
_FIELDS_OF_A_CONTROL_BLOCK = 11
_CONFIRMED_ERROR = b"\xa2"
_RESOURCE_OTHER = element(b"\xa2", element(b"\xa0", b"\x83\x01\x00"))
"""ServiceError of a ConfirmedErrorPDU: class resource, code other."""
_NEEDED_BY_CONTROLS = (b"$CF$", b"$CO$")


@dataclass(frozen=True, slots=True)
class Rewritten:
    """A message to pass on, and how many bytes of a file it carries."""

    user_data: bytes
    file_bytes: int = 0


class Rewriter:
    """Rewrites the messages of one association as the profile and the misbehaviour require.

    `report_ids` holds the reference of each report control block, "R1CFG/LLN0$BR$BRep01", by its RptID.
    """

    def __init__(
        self, files: Files | None, misbehaviour_state: MisbehaviourState, report_ids: Mapping[str, str]
    ) -> None:
        self._report_ids = report_ids
        self._files = files
        self._misbehaviour_state = misbehaviour_state
        # A block keeps its RptID while it is enabled, so an association keeps the state of its beginning.
        self._empties_report_ids = misbehaviour_state.is_on(Kind.EMPTY_RPTID)
        self._directory = ""

    def request(self, user_data: bytes) -> bytes:
        """Rewrite a client's message: its file names become those that the server knows."""
        message = _opened(user_data)
        if message is None or message.pdu_tag != _CONFIRMED_REQUEST:
            return user_data
        try:
            if message.service_tag == _FILE_DIRECTORY:
                service = decode(message.service)
                given = service.part(_FIRST)
                self._directory = "" if given is None else _names(given)[0].strip("/\\").replace("\\", "/")
                for names in service.parts or ():
                    self._rename(names, within=names.tag == _SECOND)
            elif message.service_tag == _FILE_OPEN:
                service = decode(message.service)
                opened_name = service.part(_FIRST)
                if opened_name is not None:
                    self._rename(opened_name, within=self._without_path)
            else:
                return user_data
        except MalformedError:
            return user_data
        return message.with_service(encode(service))

    def refusal(self, user_data: bytes) -> bytes | None:
        """Return the answer to a client's message that the server is not to get, None for any other.

        Controls are not refused: what a client reads to prepare one is passed on.
        """
        if not self._misbehaviour_state.is_on(Kind.READS_BUSY):
            return None
        message = _opened(user_data)
        if message is None or (message.pdu_tag, message.service_tag) != (_CONFIRMED_REQUEST, _READ):
            return None
        if any(constraint in message.service for constraint in _NEEDED_BY_CONTROLS):
            return None
        invoke_id = element(_SIMPLE_FIRST, message.head[2:])
        return message.with_pdu(_CONFIRMED_ERROR, invoke_id + _RESOURCE_OTHER)

    def response(self, user_data: bytes) -> Rewritten:
        """Rewrite a server's message."""
        message = _opened(user_data)
        if message is None:
            return Rewritten(user_data)
        try:
            if message.pdu_tag == _CONFIRMED_RESPONSE and message.service_tag == _FILE_READ:
                return Rewritten(user_data, _file_bytes(message.service))
            if message.pdu_tag == _CONFIRMED_RESPONSE and message.service_tag == _FILE_DIRECTORY:
                return Rewritten(message.with_service(_shown_listing(message.service, self._show)))
            if not self._empties_report_ids:
                return Rewritten(user_data)
            service = decode(message.service)
            if message.pdu_tag == _UNCONFIRMED:
                self._name_after_block(service)
            elif message.pdu_tag == _CONFIRMED_RESPONSE and message.service_tag == _READ:
                _empty_report_ids(service)
            else:
                return Rewritten(user_data)
        except MalformedError:
            return Rewritten(user_data)
        return Rewritten(message.with_service(encode(service)))

    def _name_after_block(self, report: Element) -> None:
        """Put the block's reference in place of its RptID, which is a report's first value."""
        values = report.part(_FIRST)
        if values is not None and values.parts and values.parts[0].tag == _VISIBLE_STRING:
            own = values.parts[0].content.decode("latin-1")
            values.parts[0].content = self._report_ids.get(own, own).encode("latin-1")

    @property
    def _without_path(self) -> bool:
        if self._misbehaviour_state.is_on(Kind.NAMES_WITHOUT_PATH):
            return True
        if self._misbehaviour_state.is_on(Kind.NAMES_WITH_PATH):
            return False
        return self._files is not None and self._files.listed == "name"

    def _rename(self, names: Element, *, within: bool) -> None:
        """Rename files as the server knows them. With `within`, a bare name is in the folder last listed."""
        for part in names.parts or ():
            name = part.content.replace(b"\\", b"/")
            if within and self._directory and b"/" not in name:
                name = self._directory.encode("latin-1") + b"/" + name
            part.content = name

    @property
    def _show(self) -> "_Show":
        most = self._misbehaviour_state.number(Kind.PARTIAL_LISTING)
        if most is None and self._files is not None:
            most = self._files.entries_per_listing
        by_bytes = self._misbehaviour_state.number(Kind.WRONG_SIZE)
        return _Show(
            without_path=self._without_path,
            separator="/" if self._files is None else self._files.separator,
            most=None if most is None else int(most),
            longer_by_bytes=None if by_bytes is None else int(by_bytes),
        )


@dataclass(frozen=True, slots=True)
class _Show:
    """How a listing is shown. An answer has at most `most` entries; the rest follows."""

    without_path: bool
    separator: str
    most: int | None
    longer_by_bytes: int | None


@lru_cache(maxsize=64)
def _shown_listing(octets: bytes, show: _Show) -> bytes:
    """Turn a listing of the server into what the relay shows. Raises MalformedError.

    Results are kept, because clients list again and again.
    """
    service = decode(octets)
    entries = _entries(service)
    if entries.parts is None:
        return octets
    if show.most is not None and len(entries.parts) > show.most:
        del entries.parts[show.most :]
        service.parts = [part for part in service.parts or () if part.tag != _SIMPLE_SECOND]
        service.parts.append(Element(_SIMPLE_SECOND, b"\xff"))
    for entry in entries.parts:
        _show_names(entry, show)
        if show.longer_by_bytes is not None:
            _change_size(entry, show.longer_by_bytes)
    return encode(service)


def _show_names(entry: Element, show: _Show) -> None:
    names = entry.part(_FIRST)
    for part in (names.parts or ()) if names is not None else ():
        name = part.content.rpartition(b"/")[2] if show.without_path else part.content
        part.content = name.replace(b"/", show.separator.encode())


@dataclass(frozen=True, slots=True)
class _Opened:
    """A message of an association, decoded down to its service.

    `context` is what stands before the PDU in the presentation's data, `head` what stands before the service
    in the PDU: its invoke id.
    """

    presentation_tags: tuple[bytes, bytes, bytes]
    context: bytes
    pdu_tag: bytes
    head: bytes
    service_tag: bytes
    service: bytes

    def with_service(self, service: bytes) -> bytes:
        """Encode the message with another service, a whole element."""
        return self.with_pdu(self.pdu_tag, self.head + service)

    def with_pdu(self, tag: bytes, content: bytes) -> bytes:
        """Encode the message with another PDU."""
        outermost, values, value = self.presentation_tags
        pdu = element(tag, content)
        return _SESSION + element(outermost, element(values, self.context + element(value, pdu)))


def _opened(user_data: bytes) -> _Opened | None:
    """Decode a message; return None for what is no data of an association or has no service."""
    if not user_data.startswith(_SESSION):
        return None
    try:
        (outermost, _, begin, end), *others = spans(user_data, len(_SESSION), len(user_data))
        (values, _, begin, end), *more = spans(user_data, begin, end)
        *before, (value, value_begin, begin, end) = spans(user_data, begin, end)
        if others or more or value != _FIRST:
            return None
        context_begin = before[0][1] if before else value_begin
        (pdu_tag, _, begin, end), *_ = spans(user_data, begin, end)
        *_, (service_tag, service_begin, _, service_end) = spans(user_data, begin, end)
    except (MalformedError, ValueError):
        return None
    return _Opened(
        (outermost, values, value),
        user_data[context_begin:value_begin],
        pdu_tag,
        user_data[begin:service_begin],
        service_tag,
        user_data[service_begin:service_end],
    )


def _file_bytes(file_read: bytes) -> int:
    """Count the bytes of a file that the answer carries. Raises MalformedError."""
    (_, _, begin, end), *_ = spans(file_read, 0, len(file_read))
    parts = spans(file_read, begin, end)
    return next((following - content for tag, _, content, following in parts if tag == _SIMPLE_FIRST), 0)


def _names(names: Element) -> list[str]:
    return [part.content.decode("latin-1") for part in names.parts or ()] or [""]


def _entries(service: Element) -> Element:
    """Return the SEQUENCE OF DirectoryEntry, which the [0] around it holds explicitly."""
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
    """Empty the RptID of control blocks among the values read.

    A control block is a structure that begins with RptID and RptEna (or Resv).
    """
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
