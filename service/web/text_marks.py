"""Times, days and commands within sentences of the service, as pages write them."""

import re
from datetime import datetime
from typing import Final

from markupsafe import Markup, escape

MARK: Final = re.compile(
    r"`(?P<code>[^`\n]+)`|\b(?P<time>\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)|\b(?P<day>\d{4}-\d\d-\d\d)\b"
    r"|(?P<share>\b\d[\d.]* %)"
)
"""Fractions of a second are left as they are: whoever tells them compares clocks."""


def with_marks(text: str) -> Markup:
    """Return a text with its times in the zone of who looks, and what stands between backquotes as code.

    A day stays on one line, and a share with its sign. All the rest is text, whoever has written it.
    """
    parts: list[Markup] = []
    end = 0
    for found in MARK.finditer(text):
        parts += [escape(text[end : found.start()]), _marked(found)]
        end = found.end()
    return Markup("").join([*parts, escape(text[end:])])


def _marked(found: re.Match[str]) -> Markup:
    if found["code"] is not None:
        return Markup("<code>{}</code>").format(found["code"])
    together = found["day"] or found["share"]
    if together is not None:
        return Markup('<span class="nowrap">{}</span>').format(together)
    try:
        words = f"{datetime.fromisoformat(found['time']):%Y-%m-%d %H:%M:%S} UTC"
    except ValueError:  # it looks like a time, and is none
        return escape(found[0])
    return Markup('<time datetime="{}" title="{}" data-local="seconds">{}</time>').format(
        found["time"], words, words
    )
