"""Rotor and supply in words."""

from dataclasses import replace

from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from service.client.rotor_and_supply import (
    gap_words,
    rotor_words,
    sideband_words,
    supply_words,
    swing_words,
)
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SHORT_RECORD,
    SUPPLY,
    SWINGING_LOAD,
)


def test_a_rotor_is_told_with_what_would_be_seen() -> None:
    assert rotor_words(BROKEN_ROTOR) == "fault, asymmetry -29.0 dB [-31.0..-27.5]; detection limit -52.0 dB"
    assert sideband_words(BROKEN_ROTOR) == (
        "-35.5 dB below, -41.0 dB above the supply's line, at a slip of 3.10 %"
    )
    assert (rotor_words(SHORT_RECORD), sideband_words(SHORT_RECORD)) == ("not assessed", None)


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


def test_air_gap_and_load_are_told_where_they_stand_out() -> None:
    assert gap_words(ECCENTRIC_ROTOR) == (
        "permeance ripples by 5.25 % (+-0.39 %) once a turn; 0.75 % would be told"
    )
    assert gap_words(replace(ECCENTRIC_ROTOR, permeance_ripple=0.0075)) is None
    assert swing_words(ECCENTRIC_ROTOR, SWINGING_LOAD) == [
        "torque swings by 6.25 % of the rated one at 4.12 Hz; 0.40 % would be told"
    ]
    once_a_turn = replace(ECCENTRIC_ROTOR, load_torque=0.05)
    assert swing_words(once_a_turn, replace(SWINGING_LOAD, load_torque=0.004)) == [
        "torque swings by 5.00 % of the rated one at 24.25 Hz, once a turn; 1.13 % would be told"
    ]


def test_what_sound_motors_and_steady_loads_show_is_not_told() -> None:
    assert gap_words(replace(ECCENTRIC_ROTOR, permeance_ripple=0.003, detection_limit=0.002)) is None
    assert swing_words(ECCENTRIC_ROTOR, replace(SWINGING_LOAD, load_torque=0.003, noise=0.00001)) == []


def test_of_a_record_that_cannot_tell_nothing_is_said_of_air_gap_and_load() -> None:
    untold = EccentricityFinding.untold("too short"), PulsationFinding.untold("too short")
    assert (gap_words(untold[0]), swing_words(*untold)) == (None, [])
