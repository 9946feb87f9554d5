"""Finds which unit was probably given for another, where figures of a motor cannot be right as they are."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite, nan, pi

from core.machines.parameters import MAGNETISING_OVER_SELF

KILO = 1e3
LEAKAGES = ("stator_leakage_H", "rotor_leakage_H")
SELF_INDUCTANCE = ("stator_self_inductance_H",)
INDUCTANCES = (*LEAKAGES, *SELF_INDUCTANCE)
REACTANCES = dict(zip(INDUCTANCES, ("X1", "X2'", "Xm"), strict=True))
"""What a data sheet has where a motor's file has inductances."""
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
    factors : tuple of float
        From the units that were given to those of the keys.
    words : str
        Both units in words.
    """

    table: str
    keys: tuple[str, ...]
    factors: tuple[float, ...]
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
        given = zip(slip.keys, slip.factors, strict=True)
        products = {key: _number(values.get(key)) * factor for key, factor in given}
        meant = {key: value for key, value in products.items() if isfinite(value)}
        if meant and keys in ((), slip.keys) and is_plausible({**table, slip.table: {**values, **meant}}):
            figures = ", ".join(f"{key} = {value:.6g}" for key, value in meant.items())
            keys = slip.keys
            found.append(f"{figures}, for {slip.words}")
    return "; or ".join(found) or None


def _slips(table: Mapping[str, object]) -> Iterator[Slip]:
    voltage, power = ("rated_voltage_V",), ("rated_power_W",)
    yield Slip("nameplate", voltage, (KILO,), "kV were given in place of V")
    yield Slip("nameplate", power, (KILO,), "kW were given in place of W")
    yield Slip("nameplate", voltage + power, (KILO, KILO), "kV and kW were given")
    yield Slip("nameplate", power, (KILO**2,), "MW were given in place of W")
    nameplate = table.get("nameplate")
    frequency_Hz = _number(nameplate.get("rated_frequency_Hz")) if isinstance(nameplate, Mapping) else nan
    for keys in (INDUCTANCES, LEAKAGES, *((key,) for key in INDUCTANCES)):
        if frequency_Hz > 0.0:
            yield _reactances(keys, 2.0 * pi * frequency_Hz)
        yield _milli(keys, "H")
    for keys in (RESISTANCES, *((key,) for key in RESISTANCES)):
        yield _milli(keys, "ohm")


def _reactances(keys: tuple[str, ...], w: float) -> Slip:
    """Return the slip of giving reactances for inductances: Xm is that of 1.5 L_s."""
    to_H = dict.fromkeys(LEAKAGES, 1.0 / w) | {SELF_INDUCTANCE[0]: 1.0 / (MAGNETISING_OVER_SELF * w)}
    names = [REACTANCES[key] for key in keys]
    several = " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
    words = f"{several} in ohm {'was' if len(keys) == 1 else 'were'} given in place of H"
    return Slip("parameters", keys, tuple(to_H[key] for key in keys), words)


def _milli(keys: tuple[str, ...], unit: str) -> Slip:
    return Slip("parameters", keys, (1.0 / KILO,) * len(keys), f"m{unit} were given in place of {unit}")


def _number(value: object) -> float:
    """Return a number, nan for all else and for numbers that a computer cannot hold."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return nan
    try:
        return float(value)
    except OverflowError:
        return nan
