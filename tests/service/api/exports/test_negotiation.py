import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.api.exports.negotiation import preferred

OFFERED = ("application/json", "text/csv", "application/vnd.apache.parquet")


@pytest.mark.parametrize(
    ("accept", "chosen"),
    [
        (None, "application/json"),
        ("", "application/json"),
        ("*/*", "application/json"),
        ("text/csv", "text/csv"),
        ("TEXT/CSV; charset=utf-8", "text/csv"),
        ("text/*", "text/csv"),
        ("text/html, application/xhtml+xml, application/xml;q=0.9, */*;q=0.8", "application/json"),
        ("text/csv, application/json", "application/json"),
        ("text/csv;q=0.9, application/json;q=0.8", "text/csv"),
        ("application/json;q=0, */*", "text/csv"),
        ("application/vnd.apache.parquet, */*;q=0.1", "application/vnd.apache.parquet"),
        ("image/png", "application/json"),
        ("text/csv;q=much", "application/json"),
        ("text", "application/json"),
    ],
)
def test_the_type_that_a_client_likes_best(accept: str | None, chosen: str) -> None:
    assert preferred(accept, OFFERED) == chosen


@given(st.text(st.sampled_from("*/;,=q.0123456789text csvjson"), max_size=60))
def test_any_header_leads_to_an_answer(accept: str) -> None:
    assert preferred(accept, OFFERED) in OFFERED
