"""Pages as their readers see them: words, addresses, and nothing that runs."""

import httpx
from lxml import html

HOSTILE = "<script>alert(1)</script>"
"""A name or a text that others choose."""


def page(answer: httpx.Response) -> html.HtmlElement:
    """A page that was got, without a script that others wrote, or one in line."""
    assert answer.status_code == 200, answer.text
    document = html.fromstring(answer.text)
    for script in document.cssselect("script"):
        assert script.get("src") or script.get("type") == "application/json"
    return document


def words(document: html.HtmlElement, selector: str) -> list[str]:
    """The words of each element that a selector finds."""
    return [" ".join(one.text_content().split()) for one in document.cssselect(selector)]


def addresses(document: html.HtmlElement, selector: str) -> list[str]:
    """Where each of these links, or forms, or buttons of forms, leads."""
    return [
        str(one.get("href") or one.get("formaction") or one.get("action"))
        for one in document.cssselect(selector)
    ]
