"""Recorded starts, filled with what the relay's own report tells of them."""

from dataclasses import replace

from core.starts.examined import ExaminedStart, StartStress
from core.starts.filling import filled_by_report
from testing.service.starts import START

REPORTED = ExaminedStart(
    replace(START, acceleration_s=1.3, i2t_A2s=340.0, i2t_over_s=1.3, peak_current_A=90.0),
    stress=StartStress(1000.0, None, 0.34, None, "motor file", None),
)


def test_what_was_recorded_stays() -> None:
    assert filled_by_report(ExaminedStart(START), REPORTED) == (ExaminedStart(START), ())


def test_a_start_that_was_recorded_in_part_has_the_heat_of_the_whole() -> None:
    part = ExaminedStart(
        replace(START, acceleration_s=None, lowest_voltage_V=None, i2t_A2s=40.0, i2t_over_s=0.2),
        stress=StartStress(1000.0, None, 0.04, None, "motor file", None),
    )
    filled, names = filled_by_report(part, REPORTED)

    figures = {name: getattr(REPORTED.figures, name) for name in names}
    assert filled == ExaminedStart(replace(START, **figures), stress=REPORTED.stress)
    assert set(names) == {"acceleration_s", "lowest_voltage_V", "i2t_A2s", "i2t_over_s"}


def test_a_report_that_did_not_end_fills_no_time() -> None:
    part = ExaminedStart(replace(START, acceleration_s=None, i2t_A2s=40.0, i2t_over_s=0.2))
    unfinished = replace(REPORTED, figures=replace(REPORTED.figures, acceleration_s=None))
    assert filled_by_report(part, unfinished) == (part, ())
