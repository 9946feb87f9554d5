"""The picture of a trend: right where it should be, and safe whatever a motor is called."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from core.units import NANOSECONDS_PER_DAY
from service.pictures.looks import PRINT
from service.pictures.png import PictureError, png
from service.pictures.svg import NAMESPACE
from service.pictures.ticks import figure_ticks, time_ticks
from service.pictures.trend import MOST_POINTS, TrendMark, TrendPoint, thinned, trend_picture
from testing.service.plants import NOW_NS

DAY = NANOSECONDS_PER_DAY


def points(number: int, state: str = "healthy") -> list[TrendPoint]:
    return [TrendPoint(NOW_NS + day * DAY, 0.004, 0.002, 0.006, state) for day in range(number)]


def elements(svg: str, name: str) -> list[etree._Element]:
    return etree.fromstring(svg).findall(f"{{{NAMESPACE}}}{name}")


def test_a_motor_over_three_weeks() -> None:
    svg = trend_picture(
        "PUMP-A1", [*points(20), TrendPoint(NOW_NS + 20 * DAY, 0.012, 0.01, 0.014, "fault")], limit=0.01
    )
    words = [str(text.text) for text in elements(svg, "text")]
    assert words[0] == "PUMP-A1"
    assert "motor's limit 1 %" in words
    assert any(word.startswith("1.20 % at 2025-10-29") for word in words)
    assert elements(svg, "rect")[-1].get("fill") == PRINT.fault, "the last one is a fault"
    assert {circle.get("fill") for circle in elements(trend_picture("P", points(5)), "circle")} == {
        PRINT.ink
    }, "what is normal has no colour"


def test_what_would_be_seen_and_what_happened_meanwhile() -> None:
    marks = [TrendMark(NOW_NS + day * DAY, "start") for day in (-1, 3, 4)]
    svg = trend_picture("PUMP-A1", points(10), detectable=0.004, marks=marks)
    words = [str(text.text) for text in elements(svg, "text")]
    assert "detection limit 0.4 %" in words
    assert words.count("1 start") == words.count("2 start") == 1, (
        "what happened before the first record is not shown"
    )
    assert not any(word.startswith("3 ") for word in words)
    assert "Last 0.40 % on" in str(elements(svg, "title")[0].text)


def test_time_without_records_is_shown_and_a_level_far_above_is_not() -> None:
    svg = trend_picture("P", points(3), limit=0.005, ahead=0.02, detectable=0.1687, until_ns=NOW_NS + 9 * DAY)
    words = [str(text.text) for text in elements(svg, "text")]
    assert "motor's limit 0.5 %" in words
    assert "next level 2 %" in words
    assert not any("detection limit" in word for word in words)
    assert max(float(one.get("cx", "0")) for one in elements(svg, "circle")) < 320


def test_a_motor_without_records() -> None:
    assert "no record yet" in trend_picture("PUMP-A1", [])


@given(st.text(max_size=300))
def test_no_name_adds_anything_to_the_picture(name: str) -> None:
    svg = trend_picture(name, points(2))
    tags = {str(element.tag).removeprefix(f"{{{NAMESPACE}}}") for element in etree.fromstring(svg).iter()}
    assert tags <= {"svg", "title", "rect", "text", "line", "path", "circle"}


@given(
    st.lists(st.tuples(st.integers(0, 10**9), st.floats(-1, 10), st.floats(0, 10)), min_size=1, max_size=50),
    st.none() | st.floats(1e-6, 1),
)
def test_every_point_is_in_the_picture(found: list[tuple[int, float, float]], limit: float | None) -> None:
    told = [TrendPoint(NOW_NS + s * 10**9, v, v - w, v + w) for s, v, w in sorted(found)]
    for circle in elements(trend_picture("P", told, limit=limit), "circle"):
        assert 0 <= float(str(circle.get("cx"))) <= 640
        assert 0 <= float(str(circle.get("cy"))) <= 260


def test_a_hundred_thousand_points_hide_no_outlier_and_not_the_last_one() -> None:
    many = [TrendPoint(NOW_NS + k * 10**9, 0.004 + (0.1 if k == 54_321 else 0.0)) for k in range(100_000)]
    kept = thinned(many)
    assert len(kept) <= MOST_POINTS
    assert many[54_321] in kept
    assert kept[-1] is many[-1]
    assert list(kept) == sorted(kept, key=lambda point: point.time_ns)
    assert thinned(many[:MOST_POINTS]) == many[:MOST_POINTS]


@given(st.floats(0, 1e6), st.floats(1e-6, 1e6), st.integers(2, 10))
def test_figures_of_an_axis_are_few_and_within(least: float, width: float, most: int) -> None:
    ticks = figure_ticks(least, least + width, most)
    assert len(ticks) <= most + 1
    assert all(least - 1e-6 * width <= tick <= least + 1.001 * width for tick in ticks)


@given(st.integers(0, 4 * 10**18), st.integers(0, 30 * 365 * DAY))
def test_times_of_an_axis_are_few_and_within(first_ns: int, width_ns: int) -> None:
    ticks = time_ticks(first_ns, first_ns + width_ns, 7)
    assert len(ticks) <= 8
    assert all(first_ns <= time_ns <= first_ns + width_ns for time_ns, _ in ticks)


def test_png_has_twice_the_pixels_and_a_broken_picture_is_told() -> None:
    made = png(trend_picture("Förderpumpe 漢字", points(30), limit=0.01))
    assert made.startswith(b"\x89PNG")
    assert struct.unpack(">II", made[16:24]) == (960, 390)
    with pytest.raises(PictureError):
        png("<svg")
