"""Finds which unit was probably given for another, where figures of a motor cannot be right as they are."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite, nan, pi

KILO = 1e3
INDUCTANCES = ("stator_leakage_H", "rotor_leakage_H", "stator_self_inductance_H")
RESISTANCES = ("stator_resistance_ohm", "rotor_resistance_ohm")


@dataclass(frozen=True, slots=True)
class Slip:
    """Figures that were given in another unit.

    Parameters
    ----------
    table : str
        Name of their table.
    keys : tuple of str
        Their keys.
    factor : float
        From the unit that was given to the one of the key.
    words : str
        Both units in words.
    """

    table: str
    keys: tuple[str, ...]
    factor: float
    words: str


def likely_slip(
    table: Mapping[str, object], is_plausible: Callable[[Mapping[str, object]], bool]
) -> str | None:
    """Return what was probably meant, if one slip explains all that is wrong.

    Where several of the same keys do, all of those are told.

    Parameters
    ----------
    table : mapping of str to object
        The tables of a motor's file.
    is_plausible : callable
        Whether tables have nothing wrong.

    Returns
    -------
    str or None
        What was meant, such as "rated_voltage_V = 11000, for kV were given".
    """
    found: list[str] = []
    keys: tuple[str, ...] = ()
    for slip in _slips(table):
        values = table.get(slip.table)
        if not isinstance(values, Mapping):
            continue
        given = {key: _number(values.get(key)) for key in slip.keys}
        meant = {key: value * slip.factor for key, value in given.items() if isfinite(value)}
        if meant and keys in ((), slip.keys) and is_plausible({**table, slip.table: {**values, **meant}}):
            figures = ", ".join(f"{key} = {value:.6g}" for key, value in meant.items())
            keys = slip.keys
            found.append(f"{figures}, for {slip.words}")
    return "; or ".join(found) or None


def _slips(table: Mapping[str, object]) -> Iterator[Slip]:
    yield Slip("nameplate", ("rated_voltage_V",), KILO, "kV were given in place of V")
    yield Slip("nameplate", ("rated_power_W",), KILO, "kW were given in place of W")
    yield Slip("nameplate", ("rated_voltage_V", "rated_power_W"), KILO, "kV and kW were given")
    yield Slip("nameplate", ("rated_power_W",), KILO**2, "MW were given in place of W")
    nameplate = table.get("nameplate")
    frequency_Hz = _number(nameplate.get("rated_frequency_Hz")) if isinstance(nameplate, Mapping) else nan
    if frequency_Hz > 0.0:
        ohm_to_H = 1.0 / (2.0 * pi * frequency_Hz)
        yield Slip("parameters", INDUCTANCES, ohm_to_H, "reactances in ohm were given in place of H")
    for keys, unit in ((INDUCTANCES, "H"), (RESISTANCES, "ohm")):
        yield Slip("parameters", keys, 1.0 / KILO, f"m{unit} were given in place of {unit}")
        for key in keys:
            yield Slip("parameters", (key,), 1.0 / KILO, f"m{unit} were given in place of {unit}")


def _number(value: object) -> float:
    """Return a number, nan for all else and for numbers that a computer cannot hold."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return nan
    try:
        return float(value)
    except OverflowError:
        return nan
