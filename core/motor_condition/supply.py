"""The supply of a motor over its latest records, beside the limits of the standards.

- Voltage: within 10 % of the rated one (NEMA MG-1, 12.44; IEC 60034-1, 7.3, zone B).
- Frequency: -5 to +3 % of the rated one (IEC 60034-1, 7.3, zone B).
- Unbalance: NEMA MG-1, 14.36, takes 5 % off the rated power at 2 %, and advises against running above 5 %.
- Harmonics: an HVF of 0.03 (IEC 60034-1, 7.2.1.1, design N), beyond which IEC 60034-26 derates as well.

A single record may be of a moment: two of the latest three have to agree.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Final

from core.condition.kinds import State
from core.supply.definitions import LARGEST_UNBALANCE, derating
from core.supply.figures import SupplyFigures

LATEST_RECORDS, AGREEING = 3, 2
"""Latest records that are judged together, and how many of them must agree."""
VOLTAGE_DEVIATION: Final = 0.10
VOLTAGE_FAULT: Final = 0.15
"""Deviation that heats a loaded motor by a third more, and keeps it from starting a heavy load."""
FREQUENCY_BELOW, FREQUENCY_ABOVE = 0.05, 0.03
UNBALANCE: Final = 0.02
HARMONIC_VOLTAGE_FACTOR: Final = 0.03


@dataclass(frozen=True, slots=True)
class SupplyCondition:
    """The supply of a motor.

    Parameters
    ----------
    state : State
        Healthy within the limits, watch beyond one, fault where the motor should not run; unknown without a
        record.
    findings : tuple of str
        What is beyond its limit, in words; empty for a healthy supply.
    reasons : tuple of str
        Figures of the latest record, and the limits that they are beside.
    """

    state: State
    findings: tuple[str, ...]
    reasons: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Beyond:
    """A figure of one record that is beyond its limit."""

    finding: str
    state: State
    reason: str


_Check = Callable[[SupplyFigures], _Beyond | None]


def supply_condition(
    latest: Sequence[SupplyFigures], rated_frequency_hz: float | None, *, voltages_agree: bool = True
) -> SupplyCondition:
    """Judge the supply of a motor.

    Parameters
    ----------
    latest : sequence of SupplyFigures
        Figures of its latest records, the latest last; the last LATEST_RECORDS count.
    rated_frequency_hz : float or None
        Rated frequency of the motor [Hz]; None where it is not known.
    voltages_agree : bool, optional
        Whether no voltage channel is known to be wrong; the unbalance of one that is tells nothing.

    Returns
    -------
    SupplyCondition
        The condition.
    """
    counted = latest[-LATEST_RECORDS:]
    if not counted:
        return SupplyCondition(State.UNKNOWN, (), ("no record tells of the supply",))
    if len(counted) < AGREEING:
        return SupplyCondition(State.UNKNOWN, (), (f"it takes {AGREEING} records to tell of the supply",))
    found: list[_Beyond] = []
    checks: list[_Check] = [_voltage, _unbalance] if voltages_agree else []
    if rated_frequency_hz is not None:
        checks.append(partial(_frequency, rated_frequency_hz))
    checks.append(_harmonics)
    for check in checks:
        beyond = [one for figures in counted if (one := check(figures)) is not None]
        for finding in dict.fromkeys(one.finding for one in beyond):
            alike = [one for one in beyond if one.finding == finding]
            faults = [one for one in alike if one.state is State.FAULT]
            if len(alike) >= AGREEING:
                found.append(faults[-1] if len(faults) >= AGREEING else _watched(alike[-1]))
    if not found:
        return SupplyCondition(State.HEALTHY, (), (_figures(counted[-1]),))
    state = State.FAULT if any(one.state is State.FAULT for one in found) else State.WATCH
    return SupplyCondition(state, tuple(one.finding for one in found), tuple(one.reason for one in found))


def _watched(one: _Beyond) -> _Beyond:
    return _Beyond(one.finding, State.WATCH, one.reason)


def _voltage(figures: SupplyFigures) -> _Beyond | None:
    deviation = figures.voltage_deviation
    if abs(deviation) <= VOLTAGE_DEVIATION:
        return None
    side = "undervoltage" if deviation < 0.0 else "overvoltage"
    state = State.FAULT if abs(deviation) > VOLTAGE_FAULT else State.WATCH
    return _Beyond(
        side,
        state,
        f"the voltage is {deviation:+.1%} from the rated one, +-{VOLTAGE_DEVIATION:.0%} is allowed",
    )


def _frequency(rated_frequency_hz: float, figures: SupplyFigures) -> _Beyond | None:
    deviation = figures.frequency_hz / rated_frequency_hz - 1.0
    if -FREQUENCY_BELOW <= deviation <= FREQUENCY_ABOVE:
        return None
    return _Beyond(
        "frequency off its rated value",
        State.WATCH,
        f"the frequency is {deviation:+.1%} from the rated one, -{FREQUENCY_BELOW:.0%} to "
        f"+{FREQUENCY_ABOVE:.0%} is allowed",
    )


def _unbalance(figures: SupplyFigures) -> _Beyond | None:
    unbalance = figures.voltage_unbalance_nema
    if unbalance <= UNBALANCE:
        return None
    left = derating(unbalance)
    if left is None:
        words = f"above {LARGEST_UNBALANCE:.0%} a motor should not run"
    else:
        words = f"it leaves {left:.0%} of the rated power"
    return _Beyond(
        "unbalanced voltage",
        State.FAULT if left is None else State.WATCH,
        f"the voltages are unbalanced by {unbalance:.1%} (NEMA MG-1): {words}",
    )


def _harmonics(figures: SupplyFigures) -> _Beyond | None:
    factor = figures.harmonic_voltage_factor
    if factor <= HARMONIC_VOLTAGE_FACTOR:
        return None
    return _Beyond(
        "distorted voltage",
        State.WATCH,
        f"the harmonic voltage factor is {factor:.3f}, {HARMONIC_VOLTAGE_FACTOR:.2f} is allowed",
    )


ADVICE: Final = MappingProxyType(
    {
        State.WATCH: (
            "Check the supply of the bus: tap changers, capacitor banks, single-phase loads, fuses; run the "
            "motor below its rated load until then."
        ),
        State.FAULT: (
            "Have the supply put right today, and do not run the motor at its rated load until then: look "
            "for a blown fuse, an open joint of the feeder or a tap changer."
        ),
    }
)


def _figures(figures: SupplyFigures) -> str:
    return (
        f"voltage {figures.voltage_deviation:+.1%} from the rated one, unbalance "
        f"{figures.voltage_unbalance_nema:.1%}, frequency {figures.frequency_hz:.2f} Hz, harmonic voltage "
        f"factor {figures.harmonic_voltage_factor:.3f}: within the limits"
    )
