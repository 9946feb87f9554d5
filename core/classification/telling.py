"""What record or test tells two causes apart."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from core.diagnosis.causes import Cause, Causes

ANOTHER_LOAD: Final = "a record at another load"
LEADS: Final = "the resistances of the three phases from the contactor on, measured when the motor is off"
SURGE: Final = "a surge test of the winding when the motor is off"
BUS: Final = "a record of another motor of the bus at the same time"
CLAMP: Final = "a clamp meter beside the relay's current reading, phase by phase"
VOLTMETER: Final = "a voltmeter at the relay's voltage terminals, phase by phase"
SWAP: Final = "two channels swapped: an error goes with its channel, a fault stays in its phase"
FEEDER: Final = "the currents of capacitors, heaters and lighting behind the relay, with a clamp meter"
COMMISSION: Final = "a recorded start, to commission the motor from (mcc commission)"
LONGER: Final = "a record of 10 s or more near rated load"

_PAIRS: Final[Mapping[Causes, tuple[str, ...]]] = MappingProxyType(
    {
        frozenset({Cause.SHORTED_TURNS, Cause.CONNECTION}): (
            f"{ANOTHER_LOAD}: the drop over a joint grows with the current, that of shorted turns does not",
            LEADS,
            SURGE,
        ),
        frozenset({Cause.SHORTED_TURNS, Cause.VOLTAGE_CHANNEL}): (
            f"{BUS}: a wrong channel shows in the voltages, shorted turns in the currents alone",
            VOLTMETER,
            SURGE,
        ),
        frozenset({Cause.SHORTED_TURNS, Cause.CURRENT_CHANNEL}): (
            f"{ANOTHER_LOAD}: an error of a channel grows with the current, that of shorted turns does not",
            CLAMP,
            SWAP,
        ),
        frozenset({Cause.SHORTED_TURNS, Cause.SUPPLY}): (
            f"{BUS}: all of them see the supply",
            "a record at another voltage or with another unbalance",
        ),
        frozenset({Cause.SHORTED_TURNS, Cause.PARAMETERS}): (COMMISSION, SURGE),
        frozenset({Cause.SHORTED_TURNS, Cause.BEHIND_RELAY}): (
            f"{FEEDER}, with the load behind the relay switched off",
            f"{ANOTHER_LOAD}: what another load draws stays, and I1 and I2 of it are as large",
            SURGE,
        ),
        frozenset({Cause.CONNECTION, Cause.CURRENT_CHANNEL}): (CLAMP, SWAP, LEADS),
        frozenset({Cause.CONNECTION, Cause.VOLTAGE_CHANNEL}): (
            f"{ANOTHER_LOAD}: the drop over a joint grows with the current, the error of a voltage channel "
            "does not",
            VOLTMETER,
            LEADS,
        ),
        frozenset({Cause.CONNECTION, Cause.SUPPLY}): (BUS, LEADS),
        frozenset({Cause.CONNECTION, Cause.PARAMETERS}): (LEADS, COMMISSION),
        frozenset({Cause.VOLTAGE_CHANNEL, Cause.CURRENT_CHANNEL}): (VOLTMETER, CLAMP, SWAP),
        frozenset({Cause.VOLTAGE_CHANNEL, Cause.SUPPLY}): (
            f"{BUS}: the supply is the same for all, a channel is one relay's",
            VOLTMETER,
        ),
        frozenset({Cause.VOLTAGE_CHANNEL, Cause.PARAMETERS}): (VOLTMETER, COMMISSION),
        frozenset({Cause.CURRENT_CHANNEL, Cause.SUPPLY}): (CLAMP, BUS),
        frozenset({Cause.CURRENT_CHANNEL, Cause.PARAMETERS}): (CLAMP, COMMISSION),
        frozenset({Cause.SUPPLY, Cause.PARAMETERS}): (BUS, COMMISSION),
        frozenset({Cause.ROTOR, Cause.PULSATION}): (
            f"{LONGER}, and one at another load: the line of a rotor follows the slip, that of a load stays",
            "a recorded start: the line of a rotor follows the slip through it",
        ),
        frozenset({Cause.ECCENTRICITY, Cause.PULSATION}): (
            LONGER,
            "a record with the motor uncoupled: the load's swing is gone, the eccentricity is not",
        ),
        frozenset({Cause.ROTOR, Cause.ECCENTRICITY}): (LONGER,),
        frozenset({Cause.ROTOR, Cause.PARAMETERS}): (COMMISSION, LONGER),
        frozenset({Cause.LOAD, Cause.PARAMETERS}): (
            COMMISSION,
            "the power of the motor, from a meter beside the relay",
        ),
    }
)
_ALONE: Final[Mapping[Cause, tuple[str, ...]]] = MappingProxyType(
    {
        Cause.SHORTED_TURNS: (SURGE, f"{ANOTHER_LOAD}, and further records: sensors stay, faults grow"),
        Cause.CONNECTION: (LEADS, f"{ANOTHER_LOAD}, as high as possible"),
        Cause.ROTOR: (LONGER, "a recorded start"),
        Cause.SUPPLY: (BUS,),
        Cause.VOLTAGE_CHANNEL: (VOLTMETER, BUS),
        Cause.CURRENT_CHANNEL: (CLAMP, SWAP),
        Cause.PULSATION: (LONGER,),
        Cause.ECCENTRICITY: (LONGER, "the vibration of the bearings"),
        Cause.LOAD: ("what the motor drives: coupling, belt, valves", "further records"),
        Cause.PARAMETERS: (COMMISSION, "the nameplate, and the ratios of the transformers"),
        Cause.BEHIND_RELAY: (FEEDER, "a record with them switched off"),
        Cause.ASYMMETRY: (f"{ANOTHER_LOAD}, and further records over time", SURGE, LEADS),
    }
)


def what_tells(one: Causes, other: Causes) -> tuple[str, ...]:
    """Return the records and tests that tell two explanations apart, the easiest first."""
    only_one, only_other = one - other, other - one
    found: list[str] = []
    for first in sorted(only_one):
        for second in sorted(only_other):
            pair = _PAIRS.get(frozenset({first, second}))
            found += pair if pair is not None else (*_ALONE[first], *_ALONE[second])
    if not only_one or not only_other:
        found += [test for cause in sorted(only_one | only_other) for test in _ALONE[cause]]
    return tuple(dict.fromkeys(found))
