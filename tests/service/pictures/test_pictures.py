"""All pictures: told in words, the same without colours, safe whatever is shown, for pages and for paper."""

from cmath import exp as cexp
from collections.abc import Callable
from math import inf, nan, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from core.units import NANOSECONDS_PER_DAY
from service.pictures.asymmetry import MIDDLE_X, MIDDLE_Y, RADIUS, TURN, Asymmetry, asymmetry_picture
from service.pictures.load import LoadPoint, load_picture
from service.pictures.load_profile import LoadShare, load_bars, load_profile_picture
from service.pictures.looks import PAGE, PRINT, Look
from service.pictures.phasors import Phasor, phasor_picture
from service.pictures.png import png
from service.pictures.sparkline import HEIGHT, WIDTH, SparkPoint, sparkline
from service.pictures.supply import SupplyPoint, supply_picture
from service.pictures.svg import NAMESPACE
from service.pictures.trend import TrendPoint, trend_picture
from testing.service.plants import NOW_NS

DAY = NANOSECONDS_PER_DAY
FAULT = 0.012 * TURN


def spark(name: str, look: Look = PRINT) -> str:
    points = [SparkPoint(NOW_NS + day * DAY, 0.004) for day in range(20)]
    points.append(SparkPoint(NOW_NS + 20 * DAY, 0.012, "fault"))
    return sparkline(
        name, points, from_ns=NOW_NS, to_ns=NOW_NS + 90 * DAY, reference=(0.002, 0.005), limit=0.01, look=look
    )


PICTURES: dict[str, Callable[..., str]] = {
    "sparkline": spark,
    "phasors": lambda name, look=PRINT: phasor_picture(name, [Phasor(name, 230, "V")], look=look),
    "asymmetry": lambda name, look=PRINT: asymmetry_picture(
        name, Asymmetry([0.003], [FAULT], 0.003 + 0j, FAULT, 0.0045, "fault"), look=look
    ),
    "supply": lambda name, look=PRINT: supply_picture(name, [SupplyPoint(0.008, 0.06)], look=look),
    "load": lambda name, look=PRINT: load_picture(
        name, [LoadPoint(0.6, 0.012, 0.01, 0.014, "fault")], limit=0.01, look=look
    ),
    "profile": lambda name, look=PRINT: load_profile_picture(name, [LoadShare(0.6)], look=look),
    "trend": lambda name, look=PRINT: trend_picture(
        name, [TrendPoint(NOW_NS, 0.012, 0.01, 0.014, "fault")], limit=0.01, look=look
    ),
}


def elements(svg: str, name: str) -> list[etree._Element]:
    return etree.fromstring(svg).findall(f"{{{NAMESPACE}}}{name}")


def told(svg: str) -> str:
    """What the picture says to those who cannot see it."""
    return str(elements(svg, "title")[0].text)


def circles(svg: str) -> list[tuple[float, float]]:
    return [(float(str(one.get("cx"))), float(str(one.get("cy")))) for one in elements(svg, "circle")]


@pytest.mark.parametrize("kind", PICTURES)
def test_every_picture_is_told_in_words_and_can_be_printed(kind: str) -> None:
    svg = PICTURES[kind]("PUMP-A1")
    root = etree.fromstring(svg)
    assert root.get("role") == "img"
    assert "PUMP-A1" in told(svg)
    assert png(svg).startswith(b"\x89PNG")


@pytest.mark.parametrize("kind", PICTURES)
def test_a_page_gives_the_colours_and_no_picture_has_a_style(kind: str) -> None:
    svg = PICTURES[kind]("PUMP-A1", PAGE)
    assert "#" not in svg
    for element in etree.fromstring(svg).iter():
        assert not {"style", "class", "id", "href"} & {str(name) for name in element.attrib}
        for name in ("fill", "stroke"):
            colour = element.get(name, "none")
            assert colour == "none" or (colour.startswith("var(--") and colour.endswith(")"))


@pytest.mark.parametrize("kind", PICTURES)
@pytest.mark.parametrize(
    "name", ["</title><script>alert(1)</script>", '" onload="x', "\x00\x07\ud800", "漢" * 999]
)
def test_no_name_adds_anything_to_a_picture(kind: str, name: str) -> None:
    svg = PICTURES[kind](name)
    tags = {str(element.tag).removeprefix(f"{{{NAMESPACE}}}") for element in etree.fromstring(svg).iter()}
    assert tags <= {"svg", "title", "rect", "text", "line", "path", "circle"}
    assert not any(name.startswith("on") for one in etree.fromstring(svg).iter() for name in one.attrib)
    assert len(svg) < 10_000


@pytest.mark.parametrize("kind", ["sparkline", "trend", "load"])
def test_states_differ_without_colours(kind: str) -> None:
    grey = Look(*["#777777"] * 9)
    make: dict[str, Callable[[str], str]] = {
        "sparkline": lambda state: sparkline(
            "P", [SparkPoint(NOW_NS, 0.01, state)], from_ns=NOW_NS, to_ns=NOW_NS + DAY, look=grey
        ),
        "trend": lambda state: trend_picture("P", [TrendPoint(NOW_NS, 0.01, state=state)], look=grey),
        "load": lambda state: load_picture("P", [LoadPoint(0.5, 0.01, state=state)], look=grey),
    }
    drawn = set()
    for state in ("healthy", "watch", "fault", "unknown"):
        root = etree.fromstring(make[kind](state))
        root.remove(root[0])  # the words differ as well
        drawn.add(etree.tostring(root))
    assert len(drawn) == 4


def test_without_records_every_picture_says_so() -> None:
    assert "No record in this time" in told(sparkline("P", [], from_ns=0, to_ns=90 * DAY))
    assert "nothing was measured" in phasor_picture("P", [])
    assert "no record yet" in asymmetry_picture("P", Asymmetry([]))
    assert "no record yet" in supply_picture("P", [])
    assert "no record yet" in load_picture("P", [])
    assert "nothing is known yet" in load_profile_picture("P", [])


def test_what_is_no_number_is_left_out() -> None:
    for bad in (nan, inf, -inf):
        assert "No record" in told(sparkline("P", [SparkPoint(5, bad)], from_ns=0, to_ns=DAY))
        assert "nothing was measured" in phasor_picture("P", [Phasor("V", complex(bad, 0), "V")])
        assert "no record yet" in asymmetry_picture("P", Asymmetry([complex(0, bad)]))
        assert "no record yet" in supply_picture("P", [SupplyPoint(0.01, bad)])
        assert "no record yet" in load_picture("P", [LoadPoint(bad, 0.01)])
        assert load_bars([LoadShare(bad)]) == []


def test_a_sparkline_is_short_and_has_gaps_where_nothing_was_recorded() -> None:
    days = [day for day in range(90) if not 30 <= day < 40]
    points = [SparkPoint(NOW_NS + day * DAY, 0.004 + 0.0005 * (day % 3)) for day in days]
    svg = sparkline("PUMP-A1", points, from_ns=NOW_NS, to_ns=NOW_NS + 90 * DAY)
    (path,) = elements(svg, "path")
    assert str(path.get("d")).count("M") == 2
    assert len(svg) < 1200, "five hundred of them are part of a page"
    assert "over 90 days" in told(svg)
    assert "last 0.50 %, healthy" in told(svg)


@given(
    st.lists(st.tuples(st.integers(-(10**6), 10**7), st.floats(-1, 10)), max_size=60),
    st.none() | st.tuples(st.floats(0, 0.01), st.floats(0.01, 0.1)),
)
def test_a_sparkline_stays_within_its_height(
    found: list[tuple[int, float]], reference: tuple[float, float] | None
) -> None:
    points = [SparkPoint(NOW_NS + s * 10**9, level) for s, level in sorted(found)]
    svg = sparkline("P", points, from_ns=NOW_NS, to_ns=NOW_NS + 90 * DAY, reference=reference)
    for x, y in circles(svg):
        assert 0 <= x <= WIDTH
        assert 0 <= y <= HEIGHT


def test_phasors_turn_against_the_clock_and_each_unit_has_its_scale() -> None:
    phasors = [Phasor("Va", 230, "V"), Phasor("Vb", 230 * cexp(-2j * pi / 3), "V"), Phasor("Ia", 2j, "A")]
    svg = phasor_picture("PUMP-A1", phasors)
    ends = {
        str(text.text): (float(str(text.get("x"))), float(str(text.get("y"))))
        for text in elements(svg, "text")
        if len(str(text.text)) == 2
    }
    assert ends["Va"][0] > ends["Ia"][0] > ends["Vb"][0]
    assert ends["Vb"][1] > ends["Va"][1] > ends["Ia"][1], "a lag of a third of a turn points downwards"
    assert "Vb 230 V at -120.0°; Ia 2 A at 90.0°" in told(svg)


def test_the_asymmetry_says_what_was_always_there_and_what_has_come() -> None:
    svg = asymmetry_picture(
        "PUMP-A1", Asymmetry([0.003] * 20, [0.003 + FAULT] * 5, 0.003 + 0j, 0.003 + FAULT, 0.004, "fault")
    )
    assert "Mean of the dots 0.30 %, nearest to phase a" in told(svg)
    assert "change since then 1.20 %, nearest to phase b" in told(svg)
    assert [line.get("stroke") for line in elements(svg, "line")][-1] == PRINT.fault
    assert "No reference yet" in told(asymmetry_picture("P", Asymmetry([0.003])))


@given(st.lists(st.complex_numbers(max_magnitude=10, allow_nan=False), max_size=30))
def test_every_record_of_the_asymmetry_is_within_the_rings(levels: list[complex]) -> None:
    for x, y in circles(asymmetry_picture("P", Asymmetry(levels))):
        assert abs(complex(x - MIDDLE_X, y - MIDDLE_Y)) <= RADIUS + 0.2


def test_an_outlier_of_the_asymmetry_is_not_thinned_away() -> None:
    levels = [0.003 + 0j] * 5000
    levels[1234] = -0.009j
    assert any(y > MIDDLE_Y + 50 for _, y in circles(asymmetry_picture("P", Asymmetry(levels))))


def test_the_lines_of_nema_are_there_where_they_matter() -> None:
    little, much = (supply_picture("P", [SupplyPoint(v, 0.06)]) for v in (0.005, 0.055))
    assert "NEMA: less load" in little
    assert "NEMA: not advised" not in little
    assert "NEMA: not advised" in much
    assert "voltages 5.50 %, currents 6.00 %" in told(much)


def test_the_load_picture_counts_what_lies_above_the_limit() -> None:
    points = [LoadPoint(0.3, 0.004), LoadPoint(0.9, 0.011, state="fault")]
    assert "2 records between 30 % and 90 % load; 1 above the limit of 1 %" in told(
        load_picture("P", points, limit=0.01)
    )


@given(st.lists(st.tuples(st.floats(-1, 5), st.floats(0, 1e6)), max_size=40))
def test_bars_of_a_load_profile_are_shares_of_the_whole(found: list[tuple[float, float]]) -> None:
    bars = load_bars([LoadShare(load, weight) for load, weight in found])
    assert not bars or sum(bars) == pytest.approx(1.0)
    assert len(bars) <= 20


def test_a_load_profile_weighs_by_time() -> None:
    bars = load_bars([LoadShare(0.25, 1.0), LoadShare(0.3, 3.0)])
    assert bars == [0.0, 0.0, 0.25, 0.75]
    assert "Most, 75 % of the time, is at 30 to 40 % load" in told(
        load_profile_picture("P", [LoadShare(0.25, 1.0), LoadShare(0.3, 3.0)], of_what="of the time")
    )
