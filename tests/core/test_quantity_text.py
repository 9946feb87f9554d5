"""Numbers in messages and tables are as people write them."""

import pytest

from core.quantity_text import plain, with_unit


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.0, 3, "0"),
        (130_000.0, 3, "130,000"),
        (131_469.0, 3, "131,000"),
        (12_345.678, 7, "12,345.68"),
        (9_999.9, 3, "10,000"),
        (1_250.0, 3, "1250"),
        (-7.5, 3, "-7.5"),
        (0.000123456, 3, "0.000123"),
        (99.96, 3, "100"),
        (1e20, 3, "1e+20"),
        (float("inf"), 3, "inf"),
    ],
)
def test_a_number(value: float, digits: int, text: str) -> None:
    assert plain(value, digits) == text


def test_a_number_for_a_file_has_no_commas() -> None:
    assert plain(13_040.0, 3, with_commas=False) == "13000"


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (131_469.0, "A", "131 kA"),
        (8_200.0, "A", "8200 A"),
        (3_300.0, "V", "3300 V"),
        (2.5e6, "W", "2.5 MW"),
        (0.00012, "s", "120 us"),
        (0.0123, "ohm", "12.3 mohm"),
        (0.25, "A", "0.25 A"),
        (0.0, "A", "0 A"),
        (2e-9, "A", "0.000000002 A"),
        (131_469.0, "kA", "131,000 kA"),
        (0.3, "", "0.3"),
        (float("nan"), "A", "nan A"),
    ],
)
def test_a_quantity(value: float, unit: str, text: str) -> None:
    assert with_unit(value, unit) == text
