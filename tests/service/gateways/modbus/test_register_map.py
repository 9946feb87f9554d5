"""docs/integration.md has the registers as they are."""

import re
from collections.abc import Sequence
from pathlib import Path

from service.gateways.kind_codes import KIND_CODES, ROTOR_CODES
from service.gateways.modbus import register_map
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK

PAGE = (Path(__file__).parents[4] / "docs" / "integration.md").read_text(encoding="utf-8")


def rows(table: str) -> dict[str, str]:
    """The registers of a table, each with what the page says of it."""
    section = PAGE.partition(f"<!-- registers {table}: begin -->")[2].partition("<!-- registers")[0]
    return dict(re.findall(r"^\| ([\d, ]+) \| \w+ \| (.*) \|$", section, re.MULTILINE))


def words(codes: Sequence[object]) -> list[str]:
    return ["none" if code is None else str(code) for code in codes]


def test_the_page_has_the_codes() -> None:
    block = rows("block")
    codes = {
        "0": register_map.STATES,
        "1": KIND_CODES,
        "2": register_map.PHASES,
        "3": register_map.HEALTHS,
        "4": register_map.QUALITIES,
        "5": ROTOR_CODES,
        "8": register_map.PRIORITIES,
        "9": register_map.LINKS,
    }
    for register, expected in codes.items():
        found = re.findall(r"(\d+) ([\w-]+)", block[register].partition(": ")[2])
        assert found == [(str(number), word) for number, word in enumerate(words(expected))], register


def test_the_page_has_every_register() -> None:
    expected = [*map(str, range(10)), *(f"{first}, {first + 1}" for first in range(10, 32, 2))]
    assert list(rows("block")) == expected
    assert list(rows("header")) == ["0", "1", "2", "3", "4, 5", "6", "7"]
    assert f"block of {BLOCK} registers from register {FIRST_BLOCK} + {BLOCK} ×" in PAGE
