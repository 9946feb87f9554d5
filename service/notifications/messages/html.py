"""A message as HTML, for mail programs: no script, no form, nothing that is loaded from elsewhere."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from service.notifications.messages.content import Content

_TEMPLATES = Environment(
    loader=FileSystemLoader(Path(__file__).parent),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def html(content: Content) -> str:
    """Return the page; every text in it is escaped. It names its pictures as cid:NAME."""
    return _TEMPLATES.get_template("message.html").render(content=content)
