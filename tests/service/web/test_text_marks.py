"""Times and commands within sentences: marked for who reads, and nothing else is markup."""

import pytest
from lxml import html

from service.web.text_marks import with_marks
from tests.service.web.pages import HOSTILE


def test_a_time_within_a_sentence_is_one_that_a_script_writes_in_the_viewers_zone() -> None:
    marked = html.fragment_fromstring(
        with_marks("since 2026-11-06T02:27:13Z: 3.20 % more"), create_parent="p"
    )
    assert marked.text_content() == "since 2026-11-06 02:27:13 UTC: 3.20 % more"
    (time,) = marked.findall("time")
    assert time.get("datetime") == "2026-11-06T02:27:13Z"
    assert time.get("title") == "2026-11-06 02:27:13 UTC"
    assert time.get("data-local") == "seconds"


def test_a_setting_or_command_is_code_without_its_quotes() -> None:
    assert with_marks("too large (`max_file_bytes`)") == "too large (<code>max_file_bytes</code>)"


def test_a_day_stays_on_one_line() -> None:
    marked = with_marks("on 2026-12-03 (2026-11-28 to 2026-12-20)")
    spans = html.fragment_fromstring(marked, create_parent="p").findall("span")
    assert [one.text for one in spans] == ["2026-12-03", "2026-11-28", "2026-12-20"]
    assert {one.get("class") for one in spans} == {"nowrap"}


@pytest.mark.parametrize(
    "text",
    [
        HOSTILE,
        f"`{HOSTILE}`",
        f"2026-11-06T02:27:13Z{HOSTILE}",
        "2026-99-99T99:99:99Z",
        "13:05:22.25 of 2026-11-06T02:27:13.25Z",
        "one ` alone",
    ],
)
def test_all_else_is_text(text: str) -> None:
    marked = html.fragment_fromstring(with_marks(text), create_parent="p")
    assert {one.tag for one in marked.iterdescendants()} <= {"code", "time", "span"}
    assert HOSTILE not in with_marks(text)
    if "time" not in {one.tag for one in marked}:
        assert marked.text_content().replace("`", "") == text.replace("`", "")


def test_a_share_stays_with_its_sign() -> None:
    assert with_marks("phase b: 3.03 % of <its> turns") == (
        'phase b: <span class="nowrap">3.03 %</span> of &lt;its&gt; turns'
    )
