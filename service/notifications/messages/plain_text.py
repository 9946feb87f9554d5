"""A message as plain text."""

from core.error_words import one_line
from service.notifications.messages.content import Content, Section


def plain_text(content: Content) -> str:
    """Return the text; every word of a relay or a person in it is on the line where it belongs."""
    parts = [one_line(content.intro)]
    parts += [_section(section) for section in content.sections]
    parts += [one_line(words) for words in (content.rest, content.hint) if words]
    return "\n\n".join(part for part in parts if part) + "\n"


def _section(section: Section) -> str:
    lines = [one_line(section.heading)]
    lines += [f"  {name}: {one_line(words)}" for name, words in section.facts]
    lines += [f"  {words}: {address}" for words, address in section.links]
    return "\n".join(lines)
