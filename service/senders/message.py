"""A message, in all the forms that the channels take."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Severity = Literal["critical", "high", "medium", "low", "info"]
"""How urgent a message is: the priority of an alarm, or `info` where nobody needs to act."""


@dataclass(frozen=True, slots=True)
class Line:
    """A message, or a part of it, in one line. facts: the same for programs, as short texts."""

    text: str
    severity: Severity
    facts: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Attachment:
    """A file that is sent along. name: in characters that every system takes."""

    name: str
    media_type: str
    content: bytes


@dataclass(frozen=True, slots=True)
class Message:
    """What is sent. It is the same at every attempt, so that receivers can recognise a second one.

    text: for people, plain.  html: the same with pictures, which it names as cid:NAME.  pictures: PNG by
    name.  lines: for a log.  document: for programs, JSON.  thread: what mails about the same thing share.
    attachments: files, which mails alone have.
    """

    id: str
    created_ns: int
    severity: Severity
    subject: str
    text: str
    lines: tuple[Line, ...]
    document: Mapping[str, object]
    html: str | None = None
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    thread: str | None = None
    attachments: tuple[Attachment, ...] = ()
