"""Figures of a catalogue, each checked on its own: the range that motors have, and likely slips of unit."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from math import log, pi, sqrt

from core.commissioning.data_sheet import DATA_SHEET, positive
from core.commissioning.errors import CommissioningError
from core.machines.parameters import Connection, Nameplate
from core.machines.plausibility import RESISTANCE_PU
from core.quantity_text import plain

FEWEST = 3
"""Figures of a catalogue without which typical parameters are as good."""
LEAST_SPEED = 0.8
"""Rated over synchronous speed."""
RPM_PER_RAD_PER_S = 30.0 / pi

Slip = tuple[str, float]
"""What a figure may have been taken for, in words, and what it is then."""


@dataclass(frozen=True, slots=True)
class CatalogueData:
    """Figures of a catalogue at rated voltage, frequency and power; None where it has none.

    Parameters
    ----------
    efficiency, power_factor : float or None, optional
        As fractions.
    rated_current_A : float or None, optional
        Line current, rms [A].
    rated_speed_rpm : float or None, optional
        Speed [rpm].
    locked_rotor_current : float or None, optional
        Over the rated current.
    locked_rotor_torque, breakdown_torque : float or None, optional
        Over the rated torque.
    stator_resistance_ohm : float or None, optional
        Of a winding at work, where it was measured [ohm].
    """

    efficiency: float | None = None
    power_factor: float | None = None
    rated_current_A: float | None = None
    rated_speed_rpm: float | None = None
    locked_rotor_current: float | None = None
    locked_rotor_torque: float | None = None
    breakdown_torque: float | None = None
    stator_resistance_ohm: float | None = None

    @property
    def given(self) -> dict[str, float]:
        """Figures that are given, by name."""
        return {
            field.name: value for field in fields(self) if (value := getattr(self, field.name)) is not None
        }


FIGURES = {
    "efficiency": "efficiency",
    "power_factor": "power factor",
    "rated_current_A": "rated current",
    "rated_speed_rpm": "rated speed",
    "locked_rotor_current": "locked-rotor current",
    "locked_rotor_torque": "locked-rotor torque",
    "breakdown_torque": "breakdown torque",
    "stator_resistance_ohm": "stator resistance",
}
"""Figures of a catalogue in words."""


@dataclass(frozen=True, slots=True)
class _Range:
    """What motors have of a figure; usual: the middle of it; slips: what the figure could be otherwise.

    below: whether no motor reaches the end itself.
    """

    least: float
    most: float
    usual: float
    unit: str
    slips: Callable[[float], Iterable[Slip]]
    below: bool = False

    def holds(self, value: float) -> bool:
        return self.least <= value < self.most or (value == self.most and not self.below)

    def __str__(self) -> str:
        end = "to below" if self.below else "to"
        return f"{plain(self.least, 4)} {end} {plain(self.most, 4)} {self.unit}".strip()

    def likely_slip(self, value: float) -> str:
        """Return which slips would explain a value out of the range, the likeliest first; empty if none."""
        found = [one for one in self.slips(value) if self.holds(one[1])]
        found = found or [
            ("with the decimal point elsewhere", value * factor)
            for factor in (0.1, 10.0, 0.01, 100.0)
            if self.holds(value * factor)
        ]
        found.sort(key=lambda one: abs(log(one[1] / self.usual)))
        return "; ".join(f"is it {words}? then {plain(then, 4)}" for words, then in found)


def check_figures(data: CatalogueData, nameplate: Nameplate, *, fewest: int = FEWEST) -> None:
    """Check each figure of a catalogue on its own, and their number.

    Parameters
    ----------
    data : CatalogueData
        The figures.
    nameplate : Nameplate
        Rated values of the motor.
    fewest : int, default FEWEST
        How many there must be.

    Raises
    ------
    CommissioningError
        If no motor has such a figure, or there are too few.
    """
    for name, value in data.given.items():
        positive(FIGURES[name], value)
    ranges = _ranges(data, nameplate)
    for name, value in data.given.items():
        scale = 100.0 if name == "efficiency" else 1.0
        one, shown = ranges[name], value * scale
        if not one.holds(shown):
            slip = one.likely_slip(shown)
            unit = " %" if name == "efficiency" else ""
            raise CommissioningError(
                DATA_SHEET,
                FIGURES[name],
                expected=str(one),
                found=f"{plain(shown, 6)}{unit}" + (f": {slip}" if slip else ""),
            )
    if len(data.given) < fewest:
        raise CommissioningError(
            DATA_SHEET,
            "figures",
            expected=f"at least {fewest} figures of the catalogue: rated speed, rated current, power factor, "
            "efficiency, locked-rotor current and torque, breakdown torque, stator resistance; or its "
            "impedances (--r1, --r2, --x1, --xm)",
            found=", ".join(FIGURES[name] for name in data.given) or "none",
        )


def _ranges(data: CatalogueData, nameplate: Nameplate) -> dict[str, _Range]:
    """Return the range of each figure of a motor with this nameplate."""
    synchronous = 60.0 * nameplate.rated_frequency_Hz / nameplate.pole_pairs
    least_A = nameplate.rated_power_W / (sqrt(3.0) * nameplate.rated_voltage_V)
    rated_A = data.rated_current_A or 1.3 * least_A
    speed = data.rated_speed_rpm
    at_work = speed if speed is not None and LEAST_SPEED * synchronous < speed else synchronous
    rated_Nm = nameplate.rated_power_W * RPM_PER_RAD_PER_S / at_work
    base_ohm = nameplate.base_impedance_ohm

    def of_torque(value: float) -> Iterable[Slip]:
        return (
            ("in Nm", value / rated_Nm),
            ("in kNm", 1e3 * value / rated_Nm),
            ("in percent", value / 100.0),
        )

    def of_current(value: float) -> Iterable[Slip]:
        yield ("in milliamperes", value / 1e3)
        yield ("in kiloamperes", value * 1e3)
        if nameplate.connection is Connection.DELTA:
            yield ("that of a winding in delta", value * sqrt(3.0))

    return {
        "efficiency": _Range(30.0, 100.0, 92.0, "%", lambda one: (("a fraction", 100.0 * one),), below=True),
        "power_factor": _Range(0.3, 1.0, 0.86, "", lambda one: (("in percent", one / 100.0),), below=True),
        "rated_current_A": _Range(
            least_A,
            6.0 * least_A,
            1.3 * least_A,
            f"A, for {plain(nameplate.rated_power_W / 1e3)} kW at {plain(nameplate.rated_voltage_V)} V",
            of_current,
        ),
        "rated_speed_rpm": _Range(
            LEAST_SPEED * synchronous,
            synchronous,
            0.985 * synchronous,
            f"rpm, the synchronous speed of {nameplate.pole_pairs} pole pairs at "
            f"{nameplate.rated_frequency_Hz:g} Hz",
            lambda one: (
                ("in radians per second", one * RPM_PER_RAD_PER_S),
                ("in turns per second", one * 60.0),
                ("the slip in percent", synchronous * (1.0 - one / 100.0)),
                ("the slip in rpm", synchronous - one),
            ),
            below=True,
        ),
        "locked_rotor_current": _Range(
            2.0,
            15.0,
            6.5,
            "times the rated current",
            lambda one: (("in amperes", one / rated_A), ("in percent", one / 100.0)),
        ),
        "locked_rotor_torque": _Range(0.1, 8.0, 1.8, "times the rated torque", of_torque),
        "breakdown_torque": _Range(1.1, 8.0, 2.7, "times the rated torque", of_torque),
        "stator_resistance_ohm": _Range(
            RESISTANCE_PU[0] * base_ohm,
            RESISTANCE_PU[1] * base_ohm,
            0.015 * base_ohm,
            "ohm of a winding",
            lambda one: (("in milliohm", one / 1e3),),
        ),
    }
