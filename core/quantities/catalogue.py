"""Every figure of a motor that is followed over time, declared once.

From it come the columns of trends and of the tables behind them, the figures that REST and `mcc trend` answer
with, and docs/reference/quantities.md. To add one, declare it here and compute it where its subject is found.
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Literal

from core.quantities.quantity import Quantity, Role, Subject

_CI95: Final = {
    Role.CI95_LOW: "lower bound of its 95 % interval, from all causes",
    Role.CI95_HIGH: "upper bound of its 95 % interval, from all causes",
}
_SCATTER95: Final = {
    Role.SCATTER95_LOW: "lower bound of its 95 % interval, from the record's own scatter alone",
    Role.SCATTER95_HIGH: "upper bound of its 95 % interval, from the record's own scatter alone",
}
_ENDS: Final = {
    Role.CI95_LOW: "ci95_low",
    Role.CI95_HIGH: "ci95_high",
    Role.SCATTER95_LOW: "scatter95_low",
    Role.SCATTER95_HIGH: "scatter95_high",
}


def _ends(value: Quantity, meanings: Mapping[Role, str]) -> Iterator[Quantity]:
    """Yield the ends of an interval of a figure."""
    for role, meaning in meanings.items():
        name, attribute = f"{value.name}_{_ENDS[role]}", f"{value.attribute}_{_ENDS[role]}"
        yield Quantity(name, value.subject, value.unit, meaning, attribute, value.name, role, value.written)


def _beside(value: Quantity, role: Role, name: str, attribute: str, meaning: str) -> Quantity:
    """Return a figure that belongs to another one."""
    return Quantity(name, value.subject, value.unit, meaning, attribute, value.name, role, value.written)


def _stator() -> Iterator[Quantity]:
    of = Subject.STATOR
    yield Quantity("verdict", of, "", "verdict of the recording by itself", "verdict", written="")
    level = Quantity("mu_f", of, "1", "fault level: share of the turns of a phase", "mu_f", written="%")
    yield level
    yield from _ends(level, _CI95)
    yield from _ends(level, _SCATTER95)
    yield _beside(
        level,
        Role.DETECTION_LIMIT,
        "detection_limit",
        "detection_limit",
        "fault level that nine of ten such recordings show",
    )
    yield Quantity(
        "theta_f",
        of,
        "",
        "winding with the fault: 0, 1, 2 on terminals a, b, c",
        "theta_f",
        written="d",
    )
    load = Quantity("load_level", of, "1", "load torque over the rated one", "load_level", written=".3f")
    yield load
    yield from _ends(load, _CI95)


def _condition() -> Iterator[Quantity]:
    of = Subject.CONDITION
    yield Quantity("state", of, "", "state of the stator from here on", "state", written="")
    yield Quantity("kind", of, "", "kind of what stands out", "kind", written="")
    yield Quantity("phase", of, "", "phase of that: a, b or c", "phase", written="")
    for name, attribute, meaning in (
        ("condition_level", "mu_f", "fault level in all, from all recordings so far"),
        ("change", "change", "change of the fault level since the reference"),
    ):
        value = Quantity(name, of, "1", meaning, attribute, written="%")
        yield value
        yield from _ends(value, _CI95)


def _rotor() -> Iterator[Quantity]:
    of = Subject.ROTOR
    yield Quantity("rotor_state", of, "", "what the recording shows of the rotor", "state", written="")
    severity = Quantity("rotor_severity_dB", of, "dB", "rotor bar severity", "severity_dB", written=".1f")
    yield severity
    yield from _ends(severity, _CI95)
    yield _beside(
        severity,
        Role.DETECTION_LIMIT,
        "rotor_detection_limit_dB",
        "detection_limit_dB",
        "severity that the recording would show",
    )
    for name, attribute, meaning in (
        ("rotor_lower_sideband_dB", "lower_sideband_dB", "current at (1 - 2s) f, as measured"),
        ("rotor_upper_sideband_dB", "upper_sideband_dB", "current at (1 + 2s) f, as measured"),
        (
            "load_oscillation_dB",
            "load_oscillation_dB",
            "torque of the load that swings at 2 s f, over the rated one",
        ),
    ):
        yield Quantity(name, of, "dB", meaning, attribute, written=".1f")
    yield Quantity("slip", of, "1", "slip, from the fit", "slip", written="%")


def _air_gap() -> Iterator[Quantity]:
    of = Subject.AIR_GAP
    ripple = Quantity(
        "gap_permeance_ripple",
        of,
        "1",
        "air-gap eccentricity: permeance, once a turn",
        "permeance_ripple",
        written="%",
    )
    yield ripple
    yield _beside(
        ripple,
        Role.STANDARD_DEVIATION,
        "gap_permeance_ripple_deviation",
        "standard_deviation",
        "its standard deviation",
    )
    yield _beside(
        ripple,
        Role.DETECTION_LIMIT,
        "gap_detection_limit",
        "detection_limit",
        "ripple that nine of ten such recordings show",
    )
    for side, at in (("lower", "f - f_r"), ("upper", "f + f_r")):
        yield Quantity(
            f"gap_{side}_sideband_dB",
            of,
            "dB",
            f"current at {at}, as measured",
            f"{side}_sideband_dB",
            written=".1f",
        )
    torque = Quantity(
        "turn_load_torque",
        of,
        "1",
        "torque that swings once a turn, over the rated one",
        "load_torque",
        written="%",
    )
    yield torque
    yield _beside(
        torque,
        Role.STANDARD_DEVIATION,
        "turn_load_torque_deviation",
        "load_torque_deviation",
        "its standard deviation",
    )
    yield Quantity(
        "turn_frequency_hz", of, "Hz", "turns of the shaft", "rotation_frequency_hz", written=".3f"
    )


def _load() -> Iterator[Quantity]:
    of = Subject.LOAD
    torque = Quantity(
        "swing_load_torque",
        of,
        "1",
        "largest torque oscillation, over the rated torque",
        "load_torque",
        written="%",
    )
    yield torque
    yield _beside(
        torque,
        Role.STANDARD_DEVIATION,
        "swing_load_torque_deviation",
        "load_torque_deviation",
        "its standard deviation",
    )
    yield _beside(
        torque,
        Role.DETECTION_LIMIT,
        "swing_detection_limit",
        "detection_limit",
        "swing that nine of ten such recordings show",
    )
    yield Quantity("swing_noise", of, "1", "what noise makes of it, rms", "noise", written="%")
    yield Quantity("swing_frequency_hz", of, "Hz", "frequency of that swing", "frequency_hz", written=".3f")


def _supply() -> Iterator[Quantity]:
    for name, unit, written, meaning in (
        ("frequency_hz", "Hz", ".3f", "frequency of the supply"),
        ("voltage_deviation", "1", "%", "mean line voltage over the rated one, minus 1"),
        ("voltage_unbalance_iec", "1", "%", "unbalance of the voltages, |V2| / |V1|"),
        ("voltage_unbalance_nema", "1", "%", "unbalance of the line voltages by NEMA MG-1"),
        ("derating", "1", ".3f", "share of the rated power that the unbalance leaves, NEMA MG-1"),
        ("thd_voltage", "1", "%", "total harmonic distortion of the voltage"),
        ("harmonic_voltage_factor", "1", ".4f", "HVF of NEMA MG-1"),
        ("current_unbalance", "1", "%", "unbalance of the line currents, |I2| / |I1|"),
        ("thd_current", "1", "%", "total harmonic distortion of the current"),
        ("active_power_W", "W", ".4g", "power drawn from the supply"),
        ("power_factor", "1", ".3f", "power factor"),
    ):
        yield Quantity(name, Subject.SUPPLY, unit, meaning, name, written=written)


def _losses() -> Iterator[Quantity]:
    of = Subject.LOSSES
    for name, unit, written, meaning in (
        ("efficiency", "1", "%", "power at the shaft over power drawn"),
        ("losses_W", "W", ".4g", "all losses of the motor"),
    ):
        value = Quantity(name, of, unit, meaning, name, written=written)
        yield value
        yield from _ends(value, _CI95)
    for name, meaning in (
        ("output_W", "power at the shaft"),
        ("turns_loss_W", "losses by shorted turns"),
        ("unbalance_loss_W", "losses by the unbalance of the supply"),
        ("voltage_loss_W", "losses because the voltage is not the rated one"),
        ("rotor_loss_W", "losses by a faulty cage"),
    ):
        yield Quantity(name, of, "W", meaning, name)


def _parameters() -> Iterator[Quantity]:
    for parameter, meaning in (
        ("stator_resistance", "change of R_s since the first records, the load's heat taken out"),
        ("rotor_resistance", "change of R_r' beyond that of R_s"),
        ("magnetising_inductance", "change of the magnetising inductance"),
        ("leakage_inductance", "change of the total leakage"),
    ):
        name, margin = f"{parameter}_change", f"{parameter}_margin"
        change = Quantity(name, Subject.PARAMETERS, "1", meaning, name, written="%")
        yield change
        yield _beside(change, Role.MARGIN, margin, margin, "half of its 95 % interval")


QUANTITIES: Final[tuple[Quantity, ...]] = (
    *_stator(),
    *_condition(),
    *_rotor(),
    *_air_gap(),
    *_load(),
    *_supply(),
    *_losses(),
    *_parameters(),
)
"""In the order of an export's columns."""

BY_NAME: Final[Mapping[str, Quantity]] = MappingProxyType({one.name: one for one in QUANTITIES})

TRENDED: Final[tuple[str, ...]] = tuple(one.name for one in QUANTITIES if one.is_trended)
"""Names of the figures that have a trend of their own."""

if TYPE_CHECKING:
    TrendedName = str
else:
    TrendedName = Literal[TRENDED]
    """One of these, where a request or an option names it."""


def of_subject(subject: Subject) -> tuple[Quantity, ...]:
    """Return what is told of a subject, in the order of the catalogue."""
    return tuple(one for one in QUANTITIES if one.subject is subject)


def beside(name: str) -> Mapping[Role, Quantity]:
    """Return the figures that belong to one, by what they are to it.

    Parameters
    ----------
    name : str
        Of the figure.

    Returns
    -------
    mapping of Role to Quantity
        Its interval, scatter, limit or deviation; empty where it has none.
    """
    return {one.role: one for one in QUANTITIES if one.of == name}
