"""Which ratio of the instrument transformers would explain values that no motor of this nameplate has.

Relays write primary or secondary values and do not always say which. What they write is compared with the
nameplate: the ratio named in the file, applied or left out, kilovolts for volts, usual secondary voltages.
"""

from collections.abc import Iterator
from math import log

from core.machines.parameters import Nameplate
from core.quantity_text import plain
from core.recordings import Channel

NEAR_RATED = (0.85, 1.15)
"""Share of the rated voltage that a voltage of the right ratio has."""
SECONDARY_V = (100.0, 110.0, 115.0, 120.0)
"""Rated secondary voltages of voltage transformers, line to line (IEC 61869-3, IEEE C57.13) [V]."""
SECONDARY_RANGE_V = (85.0, 135.0)
SECONDARY_A = (5.0, 1.0)
PRIMARY_A = (
    *(10, 12.5, 15, 20, 25, 30, 40, 50, 60, 75, 80, 100, 120, 125, 150, 200, 250, 300, 400, 500, 600),
    *(750, 800, 1000, 1200, 1250, 1500, 2000, 2500, 3000, 4000, 5000),
)
"""Rated currents of current transformers (IEC 61869-2, IEEE C57.13) [A]."""
LEAST_OF_RATED = 0.95
"""Share of the motor's rated current that its transformers are made for at least."""
LIGHT = 0.2
"""Least share of the rated current that a running motor draws."""
MOST_RATED_A = 2000.0
"""Rated currents of motors are hardly larger."""
KILO = 1e3
PLACE = "[transformers] of the motor file"


def voltage_advice(volts: float, nameplate: Nameplate, channels: tuple[Channel, ...]) -> str:
    """Tell which ratio would make a voltage the rated one.

    Parameters
    ----------
    volts : float
        Voltage as it was read, line to line, rms [V].
    nameplate : Nameplate
        Rated values of the motor.
    channels : tuple of Channel
        The voltage channels.

    Returns
    -------
    str
        What explains the voltage, and the key to write; "" where it is near the rated one or nothing.
    """
    rated = nameplate.rated_voltage_V
    if volts <= 0.0 or NEAR_RATED[0] <= volts / rated <= NEAR_RATED[1]:
        return ""
    cause = voltage_cause(volts, nameplate, channels)
    if cause:
        return cause
    applied = channels[0].applied_ratio if channels else 1.0
    return _advice("voltage_ratio", rated / volts * applied, "they may be of another ratio", "about ")


def voltage_cause(volts: float, nameplate: Nameplate, channels: tuple[Channel, ...]) -> str:
    """Tell which ratio would make a voltage the rated one, where there is a reason for just that ratio.

    Parameters
    ----------
    volts : float
        Voltage as it was read, line to line, rms [V].
    nameplate : Nameplate
        Rated values of the motor.
    channels : tuple of Channel
        The voltage channels.

    Returns
    -------
    str
        What explains the voltage, and the key to write; "" where nothing does.
    """
    rated = nameplate.rated_voltage_V
    applied = channels[0].applied_ratio if channels else 1.0
    written = volts / applied
    least, most = (share * rated for share in NEAR_RATED)
    for ratio, why in _of_the_file(channels, ("volts", "kilovolts")):
        if least <= written * ratio <= most:
            return _advice("voltage_ratio", ratio, why)
    if not SECONDARY_RANGE_V[0] <= written <= SECONDARY_RANGE_V[1]:
        return ""
    secondary = min(SECONDARY_V, key=lambda usual: abs(log(written / usual)))
    why = f"they are as large as secondary volts, of transformers of about {rated:g}:{secondary:g}"
    return _advice("voltage_ratio", rated / secondary, why, "about ")


def current_advice(
    amps: float, plausible_A: tuple[float, float], rated_A: float, channels: tuple[Channel, ...]
) -> str:
    """Tell which ratio would make a current one that the motor draws.

    Parameters
    ----------
    amps : float
        Current as it was read, rms [A].
    plausible_A : tuple of float
        Least and greatest current of the motor in this operation, rms [A].
    rated_A : float
        Rated current [A].
    channels : tuple of Channel
        The current channels.

    Returns
    -------
    str
        What explains the current, and the key to write; "" where it is plausible or nothing.
    """
    least, most = plausible_A
    if amps <= 0.0 or least <= amps <= most:
        return ""
    asked = power_in_kW(amps, plausible_A, rated_A)
    return asked + (
        current_cause(amps, plausible_A, channels) or _range(amps, plausible_A, rated_A, channels)
    )


def power_in_kW(amps: float, plausible_A: tuple[float, float], rated_A: float) -> str:
    """Ask whether the rated power is in kW, where that would explain a current.

    Parameters
    ----------
    amps : float
        Current as it was read, rms [A].
    plausible_A : tuple of float
        Least and greatest current of the motor in this operation, rms [A].
    rated_A : float
        Rated current [A].

    Returns
    -------
    str
        The question, for other advice to follow; "" where that does not explain the current.
    """
    least, most = plausible_A
    # A larger motor needs less to magnetise it, so runs with a smaller share of its rated current.
    if KILO * rated_A > MOST_RATED_A or not min(least, LIGHT * rated_A) <= amps / KILO <= most:
        return ""
    return (
        "is rated_power_W of [nameplate] in kW? The currents are about 1000 times too large for it: write it "
        "in W; if it is right, "
    )


def appended(advice: str) -> str:
    """Return advice as the end of a sentence.

    Parameters
    ----------
    advice : str
        The advice, "" where there is none.

    Returns
    -------
    str
        The advice behind a semicolon; "" where there is none.
    """
    return f"; {advice}" if advice else ""


def _range(
    amps: float, plausible_A: tuple[float, float], rated_A: float, channels: tuple[Channel, ...]
) -> str:
    least, most = plausible_A
    written = amps / (channels[0].applied_ratio if channels else 1.0)
    usual = " or ".join(_usual(least / written, most / written, rated_A))
    example = f", such as {usual}" if usual else ""
    ends = f"{_to_type(least / written, 3)} to {_to_type(most / written, 3)}"
    return f"a current_ratio of {ends} in {PLACE} would explain it{example}"


def current_cause(amps: float, plausible_A: tuple[float, float], channels: tuple[Channel, ...]) -> str:
    """Tell which ratio would make a current one that the motor draws, where there is a reason for it.

    Parameters
    ----------
    amps : float
        Current as it was read, rms [A].
    plausible_A : tuple of float
        Least and greatest current of the motor in this operation, rms [A].
    channels : tuple of Channel
        The current channels.

    Returns
    -------
    str
        What explains the current, and the key to write; "" where nothing does.
    """
    least, most = plausible_A
    written = amps / (channels[0].applied_ratio if channels else 1.0)
    for ratio, why in _of_the_file(channels, ("amperes", "kiloamperes")):
        if least <= written * ratio <= most:
            return _advice("current_ratio", ratio, why)
    return ""


def _of_the_file(channels: tuple[Channel, ...], units: tuple[str, str]) -> Iterator[tuple[float, str]]:
    """Yield the ratios that a file suggests, each with what it would mean."""
    if not channels:
        return
    said, applied = channels[0].transformer_ratio, channels[0].applied_ratio
    if said is not None and applied == 1.0:
        yield said, f"the file names the ratio {said:g}:1 and calls them primary (P), but they are secondary"
    if applied != 1.0:
        yield 1.0, f"they were multiplied by a ratio of {applied:g}:1, but are primary as they are written"
    yield 1e3 * applied, f"they are {units[1]} that are called {units[0]}"
    yield 1e-3 * applied, f"they are {units[0]} that are called {units[1]}"


def _usual(least: float, most: float, rated_A: float) -> Iterator[str]:
    """Yield transformers of usual rating within the ratios: the one next above the motor's rated current."""
    for secondary in SECONDARY_A:
        fitting = (primary for primary in PRIMARY_A if primary >= LEAST_OF_RATED * rated_A)
        primary = next(fitting, PRIMARY_A[-1])
        if least <= primary / secondary <= most:
            yield f"{primary / secondary:g} ({primary:g}:{secondary:g})"


def _advice(key: str, ratio: float, why: str, about: str = "") -> str:
    return f"{why}: {key} = {about}{_to_type(ratio, 4)} in {PLACE} would explain it"


def _to_type(ratio: float, digits: int) -> str:
    """Return a ratio as it can be written into a motor's file."""
    return plain(ratio, digits, with_commas=False)
