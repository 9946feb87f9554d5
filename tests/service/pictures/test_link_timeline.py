"""The band of a link: every outage is seen, none leaves the picture, and no colour is needed."""

from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from service.pictures.link_timeline import LEAST_WIDTH, WIDTH, LinkSpan, link_timeline
from service.pictures.svg import NAMESPACE
from testing.service.plants import NOW_NS

HOUR = 3600 * 10**9


def bars(svg: str) -> dict[str, list[etree._Element]]:
    found: dict[str, list[etree._Element]] = {}
    for one in etree.fromstring(svg).findall(f"{{{NAMESPACE}}}rect"):
        found.setdefault(str(one.get("class")), []).append(one)
    return found


def test_an_outage_of_a_minute_in_a_month_is_seen_and_higher_than_the_rest() -> None:
    spans = [
        LinkSpan(NOW_NS, NOW_NS + 400 * HOUR, "up"),
        LinkSpan(NOW_NS + 400 * HOUR, NOW_NS + 400 * HOUR + HOUR // 60, "down"),
        LinkSpan(NOW_NS + 400 * HOUR + HOUR // 60, NOW_NS + 720 * HOUR, "up"),
    ]
    found = bars(link_timeline("Link of R1", spans))
    (outage,) = found["link-down"]
    assert float(str(outage.get("width"))) == LEAST_WIDTH
    assert all(float(str(outage.get("height"))) > 2 * float(str(up.get("height"))) for up in found["link-up"])


def test_what_is_not_known_looks_like_no_state() -> None:
    assert set(bars(link_timeline("R1", [LinkSpan(NOW_NS, NOW_NS + HOUR, None)]))) == {"link-not-known"}
    assert bars(link_timeline("R1", [])) == {}


@given(
    st.text(max_size=50),
    st.lists(
        st.tuples(st.integers(0, 10**15), st.sampled_from(["up", "down", "unknown", "quarantined", None])),
        max_size=30,
    ),
)
def test_nothing_leaves_the_picture(name: str, steps: list[tuple[int, str | None]]) -> None:
    spans, at_ns = [], NOW_NS
    for length_ns, state in steps:
        spans.append(LinkSpan(at_ns, at_ns + length_ns, state))
        at_ns += length_ns
    for of_state in bars(link_timeline(name, spans)).values():
        for bar in of_state:
            assert float(str(bar.get("x"))) >= 0
            assert float(str(bar.get("x"))) + float(str(bar.get("width"))) <= WIDTH + 0.1
