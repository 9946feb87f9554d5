"""From a template and what it shows to an answer."""

import gzip
from functools import cache
from http import HTTPStatus
from pathlib import Path
from typing import Final

from jinja2 import Environment, PackageLoader, StrictUndefined, Undefined
from starlette.datastructures import Headers
from starlette.responses import HTMLResponse

from service.condition.wording import cause
from service.web import words
from service.web.addresses import address, path_segment
from service.web.help.passages import passage
from service.web.static_files import static_tree
from service.web.text_marks import with_marks

LEAST_COMPRESSED_BYTES: Final = 1400
"""A shorter answer goes into one packet as it is."""
COMPRESSION: Final = 5

HTMX_CONFIG: Final = {
    "allowEval": False,
    "allowScriptTags": False,
    "includeIndicatorStyles": False,
    "selfRequestsOnly": True,
    "historyCacheSize": 0,
    "refreshOnHistoryMiss": True,
    "responseHandling": [
        {"code": "204", "swap": False},
        {"code": "[23]..", "swap": True},
        {"code": "[45]..", "swap": True, "error": True},
    ],
}
"""Nothing is evaluated, no style is written into the page, and what an error says is shown."""


@cache
def environment() -> Environment:
    """Return the templates: values are escaped; an unknown name is an error, and so is what is no text."""
    made = Environment(
        loader=PackageLoader("service.web"),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=printed,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals |= {
        "static": static_tree().address,
        "address": address,
        "passage": passage,
        "htmx_config": HTMX_CONFIG,
        "STATE_WORDS": words.STATE_WORDS,
    }
    made.filters |= {
        "segment": path_segment,
        "percent": words.percent,
        "interval": words.interval,
        "utc": words.utc,
        "rfc3339": words.rfc3339,
        "figure": words.figure,
        "bytes": words.size,
        "age": words.age,
        "duration": words.duration,
        "phrase": words.phrase,
        "cause": cause,
        "marked": with_marks,
    }
    return made


def printed(value: object) -> object:
    """Return a value that a template prints. Raises TypeError where people could not read it."""
    if isinstance(value, str | int | float | Path | Undefined) and not isinstance(value, bool):
        return value
    raise TypeError(f"a template prints text, numbers and paths, found {type(value).__name__}")


def rendered(template: str, **data: object) -> str:
    """Return what a template makes of data."""
    return environment().get_template(template).render(data)


def html_response(
    text: str, headers: Headers, *, status: int = HTTPStatus.OK, cache: str = "private, no-cache"
) -> HTMLResponse:
    """Return an answer with a page or a part of one, compressed where the browser takes that.

    headers: those of the request.
    """
    about = about_html(cache)
    body = text.encode()
    if len(body) >= LEAST_COMPRESSED_BYTES and "gzip" in headers.get("accept-encoding", ""):
        body, about["Content-Encoding"] = gzip.compress(body, COMPRESSION, mtime=0), "gzip"
    return HTMLResponse(body, status_code=status, headers=about)


def about_html(cache: str = "private, no-cache") -> dict[str, str]:
    """Return the headers of every answer with a page or a part of one."""
    return {"Cache-Control": cache, "Vary": "Accept-Encoding, HX-Request"}
