"""What a message says, before it is text or HTML."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from service.senders.message import Attachment, Line, Severity


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a message about one thing. facts: names with what they are.  links: words with addresses.

    picture: the name of the picture that belongs to it.
    """

    heading: str
    severity: Severity
    facts: Sequence[tuple[str, str]] = ()
    links: Sequence[tuple[str, str]] = ()
    picture: str | None = None


@dataclass(frozen=True, slots=True)
class Content:
    """What a message says. subject: all of it in a line.  rest: what is not told one by one.

    lines: for a log.  document: for programs.  thread: what mails about the same thing share.
    """

    subject: str
    severity: Severity
    intro: str
    sections: Sequence[Section]
    document: Mapping[str, object]
    lines: Sequence[Line]
    rest: str | None = None
    hint: str | None = None
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    thread: str | None = None
    attachments: tuple[Attachment, ...] = ()
