"""What the length of a relay's latest record tells of its settings."""

import pytest

from service.plant.report_length import report_length


@pytest.mark.parametrize(
    ("relay_type", "cycles", "before", "frequency_Hz", "told"),
    [
        ("SEL-710", 15, 4, 50.0, ["can record 64 cycles (1.28 s): set LER := 64", "set PRE := 20"]),
        ("SEL-710", 30, 10, 60.0, ["can record 64 cycles (1.07 s): set LER := 64"]),
        ("SEL-710-5", 64, 20, 50.0, []),
        ("SEL-710", 63, 20, 50.0, []),
        ("SEL-710", 64, 4, 50.0, ["set PRE := 20"]),
        ("SEL-751", 64, 20, 50.0, ["can record 180 cycles (3.6 s): set LER := 180"]),
        ("M-3310", 15, 10, 50.0, ["not known here: see its manual"]),
    ],
)
def test_what_to_set_follows_from_the_latest_record_and_the_family(
    relay_type: str, cycles: float, before: float, frequency_Hz: float, told: list[str]
) -> None:
    found = report_length(relay_type, (cycles / frequency_Hz, before / frequency_Hz), frequency_Hz)
    assert found.cycles == pytest.approx(cycles)
    assert len(found.advice) == len(told)
    assert all(words in advice for words, advice in zip(told, found.advice, strict=True))
