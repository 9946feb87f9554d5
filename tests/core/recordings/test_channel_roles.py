"""Names, phase fields and units as relays of several makes write them."""

import tracemalloc
from collections.abc import Sequence

import pytest

from core.recordings import Quantity
from core.recordings.channel_roles import channel_roles

CURRENT, PHASE_VOLTAGE, LINE_VOLTAGE, OTHER = Quantity


def roles(*channels: tuple[str, str, str]) -> list[tuple[Quantity, str | None]]:
    return [(role.quantity, role.phase) for role in channel_roles(channels)]


@pytest.mark.parametrize(
    ("name", "phase_field", "unit", "quantity", "phase"),
    [
        ("IA", "A", "A", CURRENT, "a"),
        ("IB", "", "A", CURRENT, "b"),
        ("Ic", "", "kA", CURRENT, "c"),
        ("F1-IA", "A", "A", CURRENT, "a"),
        ("IB_G1", "B", "A", CURRENT, "b"),
        ("Popular Ic", "", "A", CURRENT, "c"),
        ("IL1", "", "A", CURRENT, "a"),
        ("I_L2", "L2", "A", CURRENT, "b"),
        ("i-L3", "L3", "A", CURRENT, "c"),
        ("IR", "R", "A", CURRENT, "a"),
        ("Current Phase A", "", "A", CURRENT, "a"),
        ("Phase B current (A)", "", "A", CURRENT, "b"),
        ("Current (Phase C) [A]", "", "A", CURRENT, "c"),
        ("I S", "", "A", CURRENT, "b"),
        ("I (A)", "", "A", CURRENT, None),  # its unit
        ("Motor I BEARING", "", "A", CURRENT, None),
        ("U L2 [V]", "", "V", PHASE_VOLTAGE, "b"),
        ("Voltage (A-N)", "", "V", PHASE_VOLTAGE, "a"),
        ("Spannung L1-L2", "", "V", LINE_VOLTAGE, "ab"),
        ("Current 1", "T", "A", CURRENT, "c"),
        ("IN", "N", "A", CURRENT, "n"),
        ("3I0", "", "A", CURRENT, None),
        ("IG", "G", "A", CURRENT, None),
        ("Ia", "1", "A", CURRENT, "a"),
        ("IA", "B", "A", CURRENT, None),
        ("IA", "AB", "A", CURRENT, None),
        ("VA", "A", "V", PHASE_VOLTAGE, "a"),
        ("Popular Va-g", "", "kV", PHASE_VOLTAGE, "a"),
        ("VCN", "", "V", PHASE_VOLTAGE, "c"),
        ("UL2E", "", "V", PHASE_VOLTAGE, "b"),
        ("U_L3", "", "V", PHASE_VOLTAGE, "c"),
        ("UL1-N", "", "V", PHASE_VOLTAGE, "a"),
        ("Ua_1", "A", "kV", PHASE_VOLTAGE, "a"),
        ("Voltage", "B-N", "V", PHASE_VOLTAGE, "b"),
        ("VAB", "", "V", LINE_VOLTAGE, "ab"),
        ("VAB", "A", "V", LINE_VOLTAGE, "ab"),
        ("V_BC", "BC", "kV", LINE_VOLTAGE, "bc"),
        ("UL1-L2", "", "V", LINE_VOLTAGE, "ab"),
        ("U23", "", "V", LINE_VOLTAGE, "bc"),
        ("UL31", "", "V", LINE_VOLTAGE, "ca"),
        ("Voltage", "C-A", "V", LINE_VOLTAGE, "ca"),
        ("VAB", "BC", "V", OTHER, None),
        ("U21", "", "V", OTHER, None),  # V1 - V2 with one maker, V2 - V1 with others
        ("Battery", "", "V", OTHER, None),
        ("VA", "A", "A", CURRENT, "a"),
        ("SRC 1 Ia Mag", "A", "A", OTHER, None),
        ("SRC 1 Va Angle", "", "deg", OTHER, None),
        ("IA rms", "A", "A", OTHER, None),
        ("Speed", "", "rpm", OTHER, None),
        ("IA", "A", "MA", OTHER, None),
        ("Via", "", "V", OTHER, None),
        ("IAW", "", "A", CURRENT, "a"),
        ("ICX", "", "A", CURRENT, "c"),
        ("IBW1", "", "A", CURRENT, "b"),
        ("IAT", "", "A", CURRENT, "a"),
        ("VBY", "", "V", PHASE_VOLTAGE, "b"),
        ("VCZ", "C", "kV", PHASE_VOLTAGE, "c"),
        ("MAGNETIC SEP IA", "A", "A", CURRENT, "a"),
        ("POSITION 3 IB", "", "A", CURRENT, "b"),
        ("Diffuser pump Ic", "", "A", CURRENT, "c"),
        ("ANGLESEY VA", "A", "V", PHASE_VOLTAGE, "a"),
        ("RMS IA", "A", "A", OTHER, None),
        ("IaMag", "A", "A", OTHER, None),
        ("IAMAG", "A", "A", OTHER, None),
        ("IA_RMS", "A", "A", OTHER, None),
        ("VAang", "A", "V", OTHER, None),
        ("IDIFA", "A", "A", OTHER, None),
        ("Idiff B", "B", "A", OTHER, None),
        ("I1 Neg", "A", "A", OTHER, None),
        ("VAC", "", "V", OTHER, None),  # any AC voltage
    ],
)
def test_one_channel(name: str, phase_field: str, unit: str, quantity: Quantity, phase: str | None) -> None:
    assert roles((name, phase_field, unit)) == [(quantity, phase)]


WORDED = (
    ("{} phase current", "{} phase voltage"),
    ("{}-Ph Current", "{}-Ph Voltage"),
    ("{}_PH_CURRENT", "{}_PH_VOLTAGE"),
    ("{} current", "{} voltage"),
    ("Amps {}", "Volts {}"),
    ("CT {}", "VT {}"),
    ("CT {}", "PT {}"),
    ("Iph{}", "Vph_{}"),
    ("I-{}", "V-{}N"),
)


@pytest.mark.parametrize("phases", ["ABC", "RYB", "UVW", ("L1", "L2", "L3")])
@pytest.mark.parametrize(("current", "voltage"), WORDED)
def test_phases_beside_words(phases: Sequence[str], current: str, voltage: str) -> None:
    channels = [(current.format(one), "", "A") for one in phases]
    channels += [(voltage.format(one), "", "V") for one in phases]
    expected = [(kind, phase) for kind in (CURRENT, PHASE_VOLTAGE) for phase in "abc"]
    assert roles(*channels) == expected


def test_phases_told_by_their_colours() -> None:
    colours = ("Red", "YELLOW", "blue")
    found = roles(
        *((f"{one} phase current", "", "A") for one in colours), *((f"V {one}", "", "V") for one in colours)
    )
    assert found == [(kind, phase) for kind in (CURRENT, PHASE_VOLTAGE) for phase in "abc"]


def test_a_motors_letter_is_no_phase() -> None:
    assert roles(("Motor A current", "", "A"), ("Motor B current", "", "A")) == [(CURRENT, None)] * 2


def test_numbered_phases_need_all_three() -> None:
    sepam = [("I1", "7", "A"), ("I2", "8", "A"), ("I3", "9", "A")]
    assert roles(*sepam) == [(CURRENT, "a"), (CURRENT, "b"), (CURRENT, "c")]
    sequence = [("I0", "", "A"), ("I1", "", "A"), ("I2", "", "A")]
    assert roles(*sequence) == [(CURRENT, None)] * 3
    assert roles(("I1", "A", "A"), ("I2", "B", "A")) == [(CURRENT, "a"), (CURRENT, "b")], "told by the field"
    assert roles(("V1", "", "V"), ("V2", "", "V"), ("V3", "", "V"))[1] == (PHASE_VOLTAGE, "b")


@pytest.mark.parametrize("letters", ["ABC", "RST", "RYB", "UVW"])
@pytest.mark.parametrize("told_by", ["name", "field", "both", "small name"])
def test_letters_of_the_phases_are_recognised_together(letters: str, told_by: str) -> None:
    """With two transformers, too: I_R and I_B are the first and the third phase."""
    first, second, third = tuple(letters)
    channels: list[tuple[str, str, str]] = []
    for kind, unit in (("I", "A"), ("V", "V")):
        for letter in letters:
            name = f"{kind}{letter}" if told_by != "field" else f"Input {len(channels)}"
            name = name.title() if told_by == "small name" else name
            channels.append((name, letter if told_by in ("field", "both") else "", unit))
    found = roles(*channels)
    assert found == [(CURRENT, p) for p in "abc"] + [(PHASE_VOLTAGE, p) for p in "abc"]
    assert roles(channels[0], channels[2]) == [(CURRENT, "a"), (CURRENT, "c")]
    lines = [(f"V{one}{two}", "", "V") for one, two in ((first, second), (second, third), (third, first))]
    assert roles(*channels[:3], *lines)[3:] == [(LINE_VOLTAGE, p) for p in ("ab", "bc", "ca")]
    turned = [(name[0] + name[:0:-1], field, unit) for name, field, unit in lines]
    assert roles(*channels[:3], *turned)[3:] == [(LINE_VOLTAGE, p) for p in ("ba", "cb", "ac")]


def test_a_set_that_is_whole_goes_before_single_letters() -> None:
    residual = [("IA", "", "A"), ("IB", "", "A"), ("IC", "", "A"), ("IR", "", "A")]
    assert roles(*residual) == [(CURRENT, "a"), (CURRENT, "b"), (CURRENT, "c"), (CURRENT, None)]
    assert roles(("IB", "", "A")) == [(CURRENT, "b")]
    assert roles(("IR", "", "A"), ("IA", "", "A")) == [(CURRENT, None), (CURRENT, "a")]
    mixed = [
        ("IA", "", "A"),
        ("IB", "", "A"),
        ("IC", "", "A"),
        ("VR", "", "V"),
        ("VY", "", "V"),
        ("VB", "", "V"),
    ]
    assert [phase for _, phase in roles(*mixed)] == ["a", "b", "c", "a", "b", "c"]


def test_a_line_voltage_the_other_way_round_needs_another_beside_it() -> None:
    assert roles(("VAB", "", "V"), ("VCB", "", "V")) == [(LINE_VOLTAGE, "ab"), (LINE_VOLTAGE, "cb")]
    assert roles(("UL1-L2", "", "V"), ("UL3-L2", "", "V")) == [(LINE_VOLTAGE, "ab"), (LINE_VOLTAGE, "cb")]
    assert roles(("VCB", "", "V")) == [(OTHER, None)]
    assert roles(("VAC", "", "V"), ("VA", "", "V")) == [(OTHER, None), (PHASE_VOLTAGE, "a")]


@pytest.mark.parametrize(
    ("unit", "si_unit", "scale"),
    [
        *(("A", "A", 1), ("kA", "A", 1e3), ("mA", "A", 1e-3)),
        *(("kV", "V", 1e3), ("KV", "V", 1e3), ("mV", "V", 1e-3), ("MV", "V", 1e6)),
        *(("Ampere", "A", 1), ("AMPS", "A", 1), ("volt", "V", 1), ("kVolts", "V", 1e3), ("À", "A", 1)),
        *(("rpm", "rpm", 1), ("", "", 1), ("VA", "VA", 1)),
    ],
)
def test_units_become_si(unit: str, si_unit: str, scale: float) -> None:
    (role,) = channel_roles([("IA", "A", unit)])
    assert (role.unit, role.scale) == (si_unit, scale)


def test_long_names_of_a_stranger_are_told_and_hold_no_memory() -> None:
    """A worker reads for months, and names are what somebody sends."""
    tracemalloc.start()
    try:
        long = [(f"{number} {'x' * 100_000} IA", "", "A") for number in range(50)]
        assert roles(*long) == [(CURRENT, "a")] * len(long)
        del long
        held_bytes, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert held_bytes < 1_000_000
