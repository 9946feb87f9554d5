"""What a channel measures, from the three things a record says of it: unit, phase field and name.

A role is only given where the record is clear. A channel whose name and phase field contradict each
other, or whose phase cannot be told, keeps phase None: the motor's file can still name it.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from core.recordings.waveform import REVERSED_LINES, Quantity

# Upper and lower case of m differ (milli, mega). "MA" is ambiguous and stays unknown.
_SI_UNITS = {
    "A": ("A", 1.0), "a": ("A", 1.0), "mA": ("A", 1e-3), "kA": ("A", 1e3), "KA": ("A", 1e3), "ka": ("A", 1e3),
    "V": ("V", 1.0), "v": ("V", 1.0), "mV": ("V", 1e-3), "kV": ("V", 1e3), "KV": ("V", 1e3), "kv": ("V", 1e3),
    "MV": ("V", 1e6),
    "А": ("A", 1.0), "мА": ("A", 1e-3), "кА": ("A", 1e3),
    "В": ("V", 1.0), "мВ": ("V", 1e-3), "кВ": ("V", 1e3),
    "À": ("A", 1.0), "ìÀ": ("A", 1e-3), "êÀ": ("A", 1e3),  # the same of CP1251, where nothing else tells it
    "Â": ("V", 1.0), "ìÂ": ("V", 1e-3), "êÂ": ("V", 1e3),
}  # fmt: skip
_UNIT_WORD = re.compile(r"(?P<prefix>[mkM]?)(?P<letter>[AaVv])(?i:(?<=a)mp(?:ere)?s?|(?<=v)olts?)")
_CYRILLIC_PHASES = str.maketrans("АВСавс", "ABCabc")
"""Letters of Cyrillic keyboards that look like those of the phases."""

_SETS = (("A", "B", "C"), ("R", "S", "T"), ("R", "Y", "B"), ("U", "V", "W"))
"""Letters of the three phases, recognised together: B is the second of A, B, C and the third of R, Y, B."""
_PLACES = ("a", "b", "c")
_NUMBERED = {"1": "a", "2": "b", "3": "c", "12": "ab", "23": "bc", "31": "ca"}
_L_PHASES = {"L1": "a", "L2": "b", "L3": "c"}

_DERIVED_WORDS = (
    "mag|magnitude|ang|angle|phase angle|rms|thd|dif|diff|differential|rst|restraint|harm|harmonics?|freq"
    "|frequency|pos|positive|neg|negative|zero|seq|sequence|spectr|spectrum|spectral"
)
_DERIVED = re.compile(rf"(?:[IVU]?[ABCNRSTY]?[0-3]?)(?:{_DERIVED_WORDS})(?:[ABCNRSTY]|[0-3])?", re.IGNORECASE)
"""Words of computed channels: they have a current's unit and name but are no waveform of a terminal."""
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[A-Z]")
"""Words of a name: letters up to a change from small ones to capitals, or to anything else."""

_NAME = re.compile(
    r"(?:^|[^A-Za-z0-9])"  # the whole name, or one word of it: "F1-IA", "IA_G1", "Popular Va-g"
    r"(?P<kind>[IVUivu])_?"
    r"(?:(?P<terminal>[ABCabc])(?P<input>[S-Z])[1-4]?(?![A-Za-z0-9])"  # IAW, VAY of relays with terminals
    r"|(?P<phase>L?[1-3](?:[-_]?L?[1-3])?|[ABCRSTUVWYabcrstuvwy]{1,2}|[Nn]))"
    r"(?:[-_]?[NGEnge])?"  # against neutral or ground
    r"(?![A-Za-z0-9])"
)
_CURRENT_WORD = r"(?:currents?|amps?|amperes?|strom|courant|corriente|corrente)"
_VOLTAGE_WORD = r"(?:voltages?|volts?|spannung|tension|tensi[oó]n|tens[aã]o)"
_ONE_PHASE = r"(?:[A-CR-WY]|L?[1-3])"
_PHASE_WORD = r"(?:phase|ph)"
_PHASE_BEFORE = (
    rf"(?i)(?<![A-Za-z0-9])(?:{_PHASE_WORD}[ _-]*(?P<p>{_ONE_PHASE})|(?P<q>{_ONE_PHASE})[ _-]*{_PHASE_WORD}"
    rf"|(?:^(?P<r>{_ONE_PHASE})|(?P<s>L[1-3])))[ _-]+"
)
_PLAIN = (
    (re.compile(r"(?i)(?<![A-Za-z])red(?![A-Za-z])"), "R"),
    (re.compile(r"(?i)(?<![A-Za-z])yellow(?![A-Za-z])"), "Y"),
    (re.compile(r"(?i)(?<![A-Za-z])blue(?![A-Za-z])"), "B"),
    (re.compile(rf"{_PHASE_BEFORE}{_CURRENT_WORD}(?![A-Za-z])"), r"I\g<p>\g<q>\g<r>\g<s>"),
    (re.compile(rf"{_PHASE_BEFORE}{_VOLTAGE_WORD}(?![A-Za-z])"), r"V\g<p>\g<q>\g<r>\g<s>"),
    (re.compile(rf"(?i)\b{_CURRENT_WORD}(?![A-Za-z]{{2}})"), "I"),
    (re.compile(rf"(?i)\b{_VOLTAGE_WORD}(?![A-Za-z]{{2}})"), "V"),
    (re.compile(rf"(?<![A-Za-z0-9])CT(?=[ _-]+{_ONE_PHASE}(?![A-Za-z0-9]))"), "I"),
    (re.compile(rf"(?<![A-Za-z0-9])[VP]T(?=[ _-]+{_ONE_PHASE}(?![A-Za-z0-9]))"), "V"),
    (re.compile(rf"(?<![A-Za-z0-9])([IUViuv])ph[ _]?(?={_ONE_PHASE}(?![A-Za-z0-9]))"), r"\1"),
    (re.compile(r"(?<![A-Za-z0-9])([IUV])[ _-]+(?=[UVW][UVWNGE](?![A-Za-z0-9]))"), r"\1"),
    (re.compile(rf"(?i)[ _(-]*\b(?:phase|ph)[ _-]*(?={_ONE_PHASE}\b)"), " "),
    (re.compile(rf"(?<![A-Za-z0-9])([IUV]) *\((?={_ONE_PHASE}-(?:{_ONE_PHASE}|[NGE])\))"), r"\1"),
    (re.compile(r"(?<![A-Za-z0-9])([IUV])[ _-]+(?=(?:[A-CR-TYabc]|L?[1-3])[^ ])"), r"\1"),
    (re.compile(rf"(?<![A-Za-z0-9])([IUV])[ _-]+(?={_ONE_PHASE}(?![A-Za-z0-9]))"), r"\1"),
)
"""Words for I and V, and what people write between them and the phase: "Current phase A" is "IA"."""
_AGAINST_EARTH = re.compile(r"(L[1-3]|[A-Z])[NGE]")


MOST_REMEMBERED, LONGEST_REMEMBERED = 4096, 256
"""Channels whose words are not looked at again, and their letters: who sends longer ones holds no memory."""


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
    IB is the third phase beside IR and IY. VCB counts as a line voltage beside another one: a single VAC may
    be any AC voltage.

    Parameters
    ----------
    channels : sequence of tuple of str
        Name, phase field and unit of each channel.

    Returns
    -------
    tuple of ChannelRole
        One role a channel.
    """
    seen = [_seen(*channel) for channel in channels]
    numbered = {(one.kind, one.name_code) for one in seen}
    numbered_kinds = {kind for kind, _ in numbered if {(kind, "1"), (kind, "2"), (kind, "3")} <= numbered}
    codes = {unit: [code for one in seen if one.unit == unit for code in one.codes] for unit in ("A", "V")}
    of_all = _lettered([*codes["A"], *codes["V"]], alone=True)
    phases = {unit: of_all or _lettered(codes[unit]) or _alphabet(_SETS[0]) for unit in codes}
    found = [_role(one, numbered_kinds, phases.get(one.unit, {})) for one in seen]
    pairs = {role.phase for role in found if role.quantity is Quantity.LINE_VOLTAGE}
    alone = len({frozenset(pair) for pair in pairs if pair}) < 2
    return tuple(
        ChannelRole(Quantity.OTHER, None, role.unit, role.scale)
        if alone and role.phase in REVERSED_LINES
        else role
        for role in found
    )


def is_computed(name: str) -> bool:
    """Tell whether a name says that a relay computed the channel from others: a magnitude, an angle.

    Parameters
    ----------
    name : str
        Name of the channel.

    Returns
    -------
    bool
        Whether one of its words does: "IA RMS", but not "MAGNETIC SEP IA".
    """
    return any(_DERIVED.fullmatch(word) for word in _WORD.findall(name))


@dataclass(frozen=True, slots=True)
class _Seen:
    """What a record says of a channel: SI unit, kind letter, and the codes of its phase in name and field."""

    unit: str
    scale: float
    kind: str
    name_code: str
    field_code: str
    is_derived: bool
    terminal: str = ""

    @classmethod
    def of(cls, name: str, phase_field: str, unit: str) -> "_Seen":
        word = _UNIT_WORD.fullmatch(unit.strip())
        si_unit, scale = _SI_UNITS.get(word["prefix"] + word["letter"].upper() if word else unit, (unit, 1.0))
        match = _NAME.search(_plain(name).translate(_CYRILLIC_PHASES))
        if match is None or (match["kind"] in "Ii") != (si_unit == "A"):
            kind, code, terminal = "", "", ""
        else:
            kind = match["kind"].upper()
            code = re.sub(r"[-_]", "", (match["terminal"] or match["phase"]).upper())
            terminal = (match["input"] or "").upper()
        field = re.sub(r"[-_ ./]", "", phase_field.upper().translate(_CYRILLIC_PHASES))
        if field.isdigit():  # often the input's number, which says nothing
            field = ""
        if earthed := _AGAINST_EARTH.fullmatch(field):
            field = earthed[1]
        return cls(si_unit, scale, kind, code, field, is_computed(name), terminal)

    @property
    def codes(self) -> tuple[str, str]:
        return ("", "") if self.is_derived else (self.name_code, self.field_code)


_remembered = lru_cache(maxsize=MOST_REMEMBERED)(_Seen.of)


def _seen(name: str, phase_field: str, unit: str) -> _Seen:
    """Return what a channel says; remembered, as all records of a relay have the same channels."""
    is_short = len(name) + len(phase_field) + len(unit) <= LONGEST_REMEMBERED
    return (_remembered if is_short else _Seen.of)(name, phase_field, unit)


def _plain(name: str) -> str:
    """Return a name with I and V in place of the words for them, and nothing between them and the phase."""
    for pattern, short in _PLAIN:
        name = pattern.sub(short, name.replace("_", " ") if short in ("I", "V") else name)
    return name


def _lettered(codes: Sequence[str], *, alone: bool = False) -> Mapping[str, str]:
    """Phases by the set of letters that all codes are of or, unless it must be alone, that is whole."""
    letters = {letter for code in codes if code.isalpha() for letter in code} - {"N", "G", "E"}
    covering = [one for one in _SETS if letters and letters <= set(one)]
    whole = [] if alone else [one for one in _SETS if set(one) <= letters]
    usual = [one for one in (covering or whole) if one is _SETS[0] or len(letters & set(one)) > 1]
    fitting = usual or covering
    if len(fitting) == 1 or (fitting and fitting[0] is _SETS[0]):
        return _alphabet(fitting[0])
    agreed = {letter: {one.index(letter) for one in fitting if letter in one} for letter in letters}
    return {letter: _PLACES[next(iter(at))] for letter, at in agreed.items() if len(at) == 1}


def _alphabet(letters: tuple[str, str, str]) -> Mapping[str, str]:
    return dict(zip(letters, _PLACES, strict=True))


def _role(seen: _Seen, numbered_kinds: set[str], letters: Mapping[str, str]) -> ChannelRole:
    role = ChannelRole(Quantity.OTHER, None, seen.unit, seen.scale)
    if seen.unit not in ("A", "V") or seen.is_derived:
        return role
    name_code = seen.name_code
    if seen.terminal in letters:  # VBY is of the phase B at the terminals Y, but a line voltage of R, Y, B
        name_code += seen.terminal
    if name_code in ("1", "2", "3") and seen.kind not in numbered_kinds:
        name_code = ""
    phase = _agreed(_phase(name_code, letters), _phase(seen.field_code, letters))
    if seen.unit == "A":
        return replace(role, quantity=Quantity.CURRENT, phase=phase if phase and len(phase) == 1 else None)
    if phase is None:
        return role
    quantity = Quantity.LINE_VOLTAGE if len(phase) == 2 else Quantity.PHASE_VOLTAGE
    return replace(role, quantity=quantity, phase=phase)


def _phase(code: str, letters: Mapping[str, str]) -> str | None:
    """Phase of a code, two for a line voltage in either direction; bare numbers have the usual one alone."""
    if code == "N":
        return "n"
    if code in _NUMBERED:
        return _NUMBERED[code]
    parts = re.findall(r"L[1-3]", code) if "L" in code else list(code)
    if code in ("L12", "L23", "L31"):
        return _NUMBERED[code[1:]]
    if "".join(parts) != code or len(parts) not in (1, 2):
        return None
    phases = [letters.get(part) or _L_PHASES.get(part) for part in parts]
    if None in phases or len(set(phases)) != len(phases):
        return None
    return "".join(phase for phase in phases if phase)


def _agreed(by_name: str | None, by_field: str | None) -> str | None:
    if by_name is None or by_field is None:
        return by_name or by_field
    if by_name == by_field:
        return by_name
    # A line voltage is often filed under its first phase.
    return by_name if len(by_name) == 2 and by_name[0] == by_field else None
