"""The values behind the pictures of a motor, as text."""

from cmath import rect
from math import nan, radians

from service.pictures.asymmetry import Asymmetry
from service.pictures.load import LoadPoint
from service.pictures.load_profile import LoadShare
from service.pictures.supply import SupplyPoint
from service.web.motor.picture_tables import asymmetry_table, load_table, profile_table, supply_table


def test_the_asymmetry_is_told_by_level_angle_and_phase() -> None:
    towards_b, towards_c = rect(0.02, radians(125.0)), rect(0.01, radians(-118.0))
    table = asymmetry_table(
        Asymmetry(before=[towards_c], since=[towards_b], standing=towards_c, now=towards_b)
    )
    assert table.rows == (
        ("what stands", "1.00 %", "-118\N{DEGREE SIGN}", "c"),
        ("with the change", "2.00 %", "125\N{DEGREE SIGN}", "b"),
        ("before", "1.00 %", "-118\N{DEGREE SIGN}", "c"),
        ("since the change", "2.00 %", "125\N{DEGREE SIGN}", "b"),
    )


def test_long_tables_have_the_latest_records_and_say_so() -> None:
    table = load_table([LoadPoint(0.5, k / 1000.0, 0.0, 0.1, "watch") for k in range(100)])
    assert len(table.rows) == 40
    assert table.told == "The latest 40 of 100 records, the latest last."
    assert table.rows[-1] == ("50 %", "9.90 %", "0.00 to 10.00 %", "watch")


def test_what_is_not_known_is_a_dash() -> None:
    assert supply_table([SupplyPoint(0.01, nan)]).rows == (("1.00 %", "–"),)
    assert load_table([LoadPoint(0.5, 0.01)]).rows == (("50 %", "1.00 %", "–", "healthy"),)


def test_the_load_profile_is_told_by_class() -> None:
    table = profile_table(
        [LoadShare(0.05), LoadShare(0.15), LoadShare(0.15), LoadShare(0.19)], "of the records"
    )
    assert table.rows == (("0 to 10 %", "25.0 %"), ("10 to 20 %", "75.0 %"))
    assert table.headings == ("load over rated", "share of the records")
