"""Addresses of our pages: names in them lead nowhere else, and nobody is sent to another site."""

from urllib.parse import unquote, urljoin, urlsplit

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.web.addresses import address, own_address, with_query

SITE = "http://plant.example:8710/login"


@given(st.text(max_size=60))
def test_no_text_leads_to_another_site(text: str) -> None:
    reached = urlsplit(urljoin(SITE, own_address(text)))
    assert (reached.scheme, reached.netloc) == ("http", "plant.example:8710")


@pytest.mark.parametrize(
    "text",
    [
        "//evil.example",
        "/\\evil.example",
        "https://evil.example",
        "/\t/evil.example",
        "javascript:alert(1)",
        "",
        None,
    ],
)
def test_what_would_lead_elsewhere_is_not_followed(text: str | None) -> None:
    assert own_address(text, "/motors") == "/motors"


def test_our_own_addresses_are_followed() -> None:
    assert own_address("/motors/FAN%20A2?from=2026-01-01#trend") == "/motors/FAN%20A2?from=2026-01-01#trend"


@given(st.text(min_size=1, max_size=40).filter(lambda name: "/" not in name))
def test_a_name_is_one_segment(name: str) -> None:
    path = address("/motors", name.encode("utf-8", "ignore").decode() or "x", site=None, text="")
    assert path.count("/") == 2
    assert path.rpartition("/")[2] not in (".", "..")
    assert unquote(path.rpartition("/")[2]) == (name.encode("utf-8", "ignore").decode() or "x")


def test_a_query_has_what_is_given() -> None:
    assert (
        address("/", site="Mill 1", state=["watch", "fault"], text="")
        == "/?site=Mill+1&state=watch&state=fault"
    )


def test_an_address_that_has_a_query_and_a_place_gets_more_of_a_query() -> None:
    assert (
        with_query("/alarms?show=history#list", {"done": "shelved"})
        == "/alarms?show=history&done=shelved#list"
    )
    assert with_query("/alarms?show=history#list", {"done": None}) == "/alarms?show=history#list"
