"""What a channel measures, from the three things a record says of it: unit, phase field and name.

A role is only given where the record is clear. A channel whose name and phase field contradict each
other, or whose phase cannot be told, keeps phase None: the motor's file can still name it.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from core.recordings.waveform import Quantity

# Upper and lower case of m differ (milli, mega). "MA" is ambiguous and stays unknown.
_SI_UNITS = {
    "A": ("A", 1.0), "a": ("A", 1.0), "mA": ("A", 1e-3), "kA": ("A", 1e3), "KA": ("A", 1e3), "ka": ("A", 1e3),
    "V": ("V", 1.0), "v": ("V", 1.0), "mV": ("V", 1e-3), "kV": ("V", 1e3), "KV": ("V", 1e3), "kv": ("V", 1e3),
    "MV": ("V", 1e6), "Amps": ("A", 1.0), "Volts": ("V", 1.0),
    "А": ("A", 1.0), "мА": ("A", 1e-3), "кА": ("A", 1e3),
    "В": ("V", 1.0), "мВ": ("V", 1e-3), "кВ": ("V", 1e3),
}  # fmt: skip
_CYRILLIC_PHASES = str.maketrans("АВСавс", "ABCabc")
"""Letters of Cyrillic keyboards that look like those of the phases."""

_PHASES = {"A": "a", "B": "b", "C": "c", "N": "n", "L1": "a", "L2": "b", "L3": "c"}
_PHASES |= {"R": "a", "S": "b", "T": "c"}
_LINES = {"AB": "ab", "BC": "bc", "CA": "ca", "L12": "ab", "L23": "bc", "L31": "ca"}
_LINES |= {"L1L2": "ab", "L2L3": "bc", "L3L1": "ca", "RS": "ab", "ST": "bc", "TR": "ca"}
_NUMBERED = {"1": "a", "2": "b", "3": "c", "12": "ab", "23": "bc", "31": "ca"}

_DERIVED = re.compile(r"mag|ang|rms|thd|dif|rst|harm|freq|pos|neg|zero|seq|spectr", re.IGNORECASE)
"""Words of computed channels: they have a current's unit and name but are no waveform of a terminal."""

_NAME = re.compile(
    r"(?:^|[^A-Za-z0-9])"  # the whole name, or one word of it: "F1-IA", "IA_G1", "Popular Va-g"
    r"(?P<kind>[IVUivu])_?"
    r"(?P<phase>L?[1-3](?:[-_]?L?[1-3])?|[ABCRSTabcrst]{1,2}|[Nn])"
    r"(?:[-_]?[NGEnge])?"  # against neutral or ground
    r"(?![A-Za-z0-9])"
)


@dataclass(frozen=True, slots=True)
class ChannelRole:
    """What a channel measures, and how its unit becomes SI.

    Parameters
    ----------
    quantity : Quantity
        What the channel measures.
    phase : str or None
        Phase as in `Channel`, None if unknown.
    unit : str
        SI unit.
    scale : float
        Factor from the file's unit to the SI unit.
    """

    quantity: Quantity
    phase: str | None
    unit: str
    scale: float


def channel_roles(channels: Sequence[tuple[str, str, str]]) -> tuple[ChannelRole, ...]:
    """Return the roles of the channels of one record.

    They are judged together: I1, I2, I3 are phase currents; I1 and I2 beside an I0 are sequence components.

    Parameters
    ----------
    channels : sequence of tuple of str
        Name, phase field and unit of each channel.

    Returns
    -------
    tuple of ChannelRole
        One role a channel.
    """
    matches = [_NAME.search(name.translate(_CYRILLIC_PHASES)) for name, _, _ in channels]
    digits = {(m["kind"].upper(), m["phase"]) for m in matches if m and m["phase"] in _NUMBERED}
    numbered_kinds = {kind for kind, _ in digits if {(kind, "1"), (kind, "2"), (kind, "3")} <= digits}
    return tuple(
        _role(name, phase_field, unit, match, numbered_kinds)
        for (name, phase_field, unit), match in zip(channels, matches, strict=True)
    )


def _role(
    name: str, phase_field: str, unit: str, match: re.Match[str] | None, numbered_kinds: set[str]
) -> ChannelRole:
    si_unit, scale = _SI_UNITS.get(unit, (unit, 1.0))
    role = ChannelRole(Quantity.OTHER, None, si_unit, scale)
    if si_unit not in ("A", "V") or _DERIVED.search(name):
        return role
    phase = _agreed(_phase_of_name(match, si_unit, numbered_kinds), _phase_of_field(phase_field))
    if si_unit == "A":
        return replace(role, quantity=Quantity.CURRENT, phase=phase if phase in _PHASES.values() else None)
    if phase is None:
        return role
    quantity = Quantity.LINE_VOLTAGE if phase in _LINES.values() else Quantity.PHASE_VOLTAGE
    return replace(role, quantity=quantity, phase=phase)


def _phase_of_name(match: re.Match[str] | None, si_unit: str, numbered_kinds: set[str]) -> str | None:
    if match is None or (match["kind"] in "Ii") != (si_unit == "A"):
        return None
    code = re.sub(r"[-_]", "", match["phase"].upper())
    if code in ("1", "2", "3") and match["kind"].upper() not in numbered_kinds:
        return None
    return _PHASES.get(code) or _LINES.get(code) or _NUMBERED.get(code)


def _phase_of_field(phase_field: str) -> str | None:
    """Phase of the `ph` field; bare numbers there are often the input's number and say nothing."""
    code = re.sub(r"[-_ ./]", "", phase_field.upper().translate(_CYRILLIC_PHASES))
    if code in ("AN", "BN", "CN", "AG", "BG", "CG", "L1N", "L2N", "L3N", "L1E", "L2E", "L3E"):
        code = code[:-1]
    return _PHASES.get(code) or _LINES.get(code)


def _agreed(by_name: str | None, by_field: str | None) -> str | None:
    if by_name is None or by_field is None:
        return by_name or by_field
    if by_name == by_field:
        return by_name
    # A line voltage is often filed under its first phase.
    return by_name if len(by_name) == 2 and by_name[0] == by_field else None
