"""Rotor and supply in words."""

from dataclasses import replace

from service.client.rotor_and_supply import rotor_words, sideband_words, supply_words
from testing.service.rotor_and_supply import BROKEN_ROTOR, SHORT_RECORD, SUPPLY


def test_a_rotor_is_told_with_what_would_be_seen() -> None:
    assert rotor_words(BROKEN_ROTOR) == "fault, asymmetry -29.0 dB [-31.0..-27.5]; -52.0 dB would be seen"
    assert sideband_words(BROKEN_ROTOR) == (
        "-35.5 dB below, -41.0 dB above the supply's line, at a slip of 3.10 %"
    )
    assert (rotor_words(SHORT_RECORD), sideband_words(SHORT_RECORD)) == ("not told", None)


def test_a_supply_is_told_with_its_derating() -> None:
    assert supply_words(SUPPLY) == [
        "398.9 V (-0.3%), 50.010 Hz",
        "unbalance 0.71 % (IEC), 0.68 % (NEMA), derating 1.00",
        "distortion of the voltage 2.10 %, HVF 0.0085",
        "612.5 W, power factor 0.610",
    ]
    unbalanced = replace(SUPPLY, derating=None, active_power_W=None, power_factor=None)
    assert supply_words(unbalanced)[1:] == [
        "unbalance 0.71 % (IEC), 0.68 % (NEMA), do not run (NEMA MG-1)",
        "distortion of the voltage 2.10 %, HVF 0.0085",
    ]
