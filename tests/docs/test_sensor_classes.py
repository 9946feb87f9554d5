"""The motor file's page lists the relay models whose class of sensors the service knows."""

import re
from pathlib import Path

from core.machines.sensors import SensorClass
from service.plant.sensor_classes import RELAY_MODELS, typical_sensors

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "motor-file.md"


def test_every_relay_model_is_on_the_page_with_what_is_published() -> None:
    table = PAGE.read_text(encoding="utf-8").partition("| manufacturer, type |")[2]
    rows = re.findall(r"^\| (\w+), (\w+?)(?:\.\.\.)? \| ([^|]+) \|", table, re.MULTILINE)
    assert [(maker.upper(), model, published) for maker, model, published in rows] == [
        (known.manufacturer, known.type, known.published) for known in RELAY_MODELS
    ]


def test_a_model_is_known_by_how_its_names_begin_and_none_is_better_than_the_default() -> None:
    usual = SensorClass()
    assert typical_sensors("Siemens AG", "7SK8025-5") == SensorClass(current_gain=0.015)
    assert typical_sensors("SEL", "SEL_710") == usual
    assert typical_sensors("", "") == usual
    for known in RELAY_MODELS:
        found = typical_sensors(known.manufacturer.title(), known.type.lower())
        assert found == known.sensors
        assert found.voltage_gain >= usual.voltage_gain
        assert found.current_gain >= usual.current_gain
