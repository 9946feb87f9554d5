"""Starts over one another: what is drawn, and what is told to those who cannot see it."""

from lxml import etree

from service.pictures.starts import StartLine, starts_picture

FIRST = StartLine(0.01, 0.02, [90.0, 80.0, 40.0, 10.0, 9.0, 9.0] * 5, 0.1)
LATER = StartLine(0.01, 0.02, [95.0, 90.0, 70.0, 30.0, 9.0, 9.0] * 5, 0.12)


def paths(svg: str) -> list[dict[str, str]]:
    root = etree.fromstring(svg.encode())
    return [dict(one.attrib) for one in root.iter("{http://www.w3.org/2000/svg}path")]


def test_the_latest_is_bold_and_the_reference_dashed() -> None:
    drawn = paths(starts_picture("FAN-A2", [FIRST, LATER], reference=FIRST))
    assert len(drawn) == 3
    thin, bold, dashed = drawn
    assert float(thin["stroke-width"]) < float(bold["stroke-width"])
    assert "stroke-dasharray" in dashed
    assert "stroke-dasharray" not in bold


def test_what_is_shown_ends_soon_after_the_longest_start() -> None:
    (line,) = paths(starts_picture("FAN-A2", [LATER]))
    assert len(line["d"].split("L")) < len(LATER.values)
    (whole,) = paths(starts_picture("FAN-A2", [StartLine(0.01, 0.02, LATER.values)]))
    assert len(whole["d"].split("L")) == len(LATER.values)


def test_it_is_told_in_words() -> None:
    told = starts_picture("FAN-A2", [FIRST, LATER], reference=FIRST)
    assert "2 starts; the latest reaches 95 A, the reference 90 A" in told
    assert "no start yet" in starts_picture("FAN-A2", [])
    assert "no start yet" in starts_picture("FAN-A2", [StartLine(0.0, 0.02, [])])
    assert "no start yet" in starts_picture("FAN-A2", [StartLine(0.0, 0.02, [float("nan")])])


def test_a_hostile_name_stays_a_name() -> None:
    assert "<script>" not in starts_picture("<script>", [FIRST])


def test_a_long_start_is_thinned() -> None:
    (line,) = paths(starts_picture("FAN-A2", [StartLine(0.01, 0.02, [5.0] * 5000)]))
    assert len(line["d"].split("L")) <= 401
