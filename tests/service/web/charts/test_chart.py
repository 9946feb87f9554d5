"""A chart's description for the script, and the table of values behind it."""

import json
from math import nan, sin

from service.web.charts import AxisKind, Chart, Limit, Mark, Series, Tone
from service.web.charts.chart import chosen_rows


def chart(values: list[float | None], **others: object) -> Chart:
    """Return a chart of one series over the numbers 0, 1, 2 and so on."""
    x = [float(k) for k in range(len(values))]
    series = [Series("level", values, unit="%", tone=Tone.A)]
    return Chart("level", "Fault level", "record", "level", x, series, **others)  # type: ignore[arg-type]  # a test's own


def test_the_description_is_json_and_gaps_are_null() -> None:
    document = chart(
        [1.0, None, nan, 2.5], limits=[Limit(0.5, "limit")], marks=[Mark(2.0, "start")]
    ).document()
    told = json.loads(json.dumps(document, allow_nan=False))
    assert told["series"] == [
        {"label": "level", "unit": "%", "tone": "a", "kind": "line", "values": [1.0, None, None, 2.5]}
    ]
    assert told["limits"] == [{"y": 0.5, "label": "limit", "tone": "fault"}]
    assert told["marks"] == [{"x": 2.0, "label": "start", "tone": "muted"}]


def test_intervals_are_part_of_the_description_and_of_the_table() -> None:
    series = [Series("level", [2.0], unit="%", low=[1.0], high=[3.0])]
    one = Chart("level", "Fault level", "time", "level", [86400.0], series, x_kind=AxisKind.TIME)
    assert one.series[0].document()["low"] == [1.0]
    assert one.table.headings == ("time", "level (%)", "level: low", "level: high")
    assert one.table.rows == (("1970-01-02 00:00:00 UTC", "2", "1", "3"),)
    assert one.table.told == "All 1 values."


def test_a_long_table_is_thinned_keeps_extremes_and_says_so() -> None:
    values: list[float | None] = [sin(k / 50.0) for k in range(5000)]
    values[1234], values[4321], values[77] = 9.0, -9.0, None
    table = chart(values).table
    assert 30 < len(table.rows) <= 40
    assert ("1234", "9") in table.rows
    assert ("4321", "-9") in table.rows
    assert table.told.startswith(f"{len(table.rows)} of 5000 values")
    assert [row[0] for row in table.rows[:1] + table.rows[-1:]] == ["0", "4999"]


def test_a_chart_of_nothing_has_a_table_of_nothing() -> None:
    assert chart([]).table.rows == ()
    assert chosen_rows([[None, None]], 2, 1) == (0, 1)


def test_limits_and_marks_are_told_in_words() -> None:
    one = Chart(
        "level",
        "Fault level",
        "time",
        "level",
        [86400.0],
        [Series("level", [2.0], unit="%")],
        y_unit="%",
        x_kind=AxisKind.TIME,
        limits=[Limit(0.5, "limit"), Limit(2.0, "next level")],
        marks=[Mark(90000.0, "start"), Mark(86460.0, "note")],
    )
    assert one.lines_told == (
        "next level, at 2 %",
        "limit, at 0.5 %",
        "note, at 1970-01-02 00:01:00 UTC",
        "start, at 1970-01-02 01:00:00 UTC",
    )
