"""The thermal element (49) of SEL's motor relays, method "Rating", as their manuals publish it.

Heat U is in squared full-load currents times seconds. Above 2.5 times the full-load current the rotor's
model holds: no heat is lost, and both sequences heat alike. Below 2.4 times, the stator's model holds: a
first-order lag, in which negative-sequence current heats five times as much, and which trips at the squared
service factor.

The manuals print the equations of both models and of their trip times. They say that heat and trip value pass
from one model to the other as they are; how the trip value moves from there on is not printed. Here it
approaches the stator's with the stator's time constant, as the heat does.

References
----------
.. [1] SEL-749M Relay Instruction Manual (20080918), appendix F, equations F.10 to F.14; table 4.5.
.. [2] SEL-701 Relay Instruction Manual (20010719), appendix E. SEL-710 relays have the same settings.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import exp, isfinite, log

from core.machines.parameters import ThermalElement
from core.thermal.course import CurrentStep

STARTING, STARTED = 2.5, 2.4
"""Currents, over full load, above which a motor starts, and below which it has started."""
NEGATIVE_SEQUENCE_WHILE_RUNNING = 5.0
OPERATING_HEAT = 0.2
"""Heat of a motor at operating temperature, over that of a locked rotor in its hot limit time."""
HOT = 0.9
"""Current, over the service factor, that brings a stator to operating temperature."""
STANDSTILL = 3.0
"""Time constant of a motor that stands over that of one that runs (examples of the manual)."""


@dataclass(frozen=True, slots=True)
class RelaySettings:
    """Settings of the thermal element.

    Parameters
    ----------
    service_factor : float
        SF, 1.01 to 1.5.
    locked_rotor_current : float
        LRA, over the full-load current, 2.5 to 12.
    locked_rotor_time_s : float
        LRTHOT, time a hot motor bears with its rotor locked [s].
    acceleration_factor : float, default 1.0
        TD, of that time.
    running_time_constant_s : float or None, optional
        RTC [s]; None for the relay's "Auto".
    standstill_time_constant_s : float or None, optional
        Time constant while the motor stands [s]; None for three times that of running.

    Raises
    ------
    ValueError
        If the service factor is not between 1 and the locked-rotor current, or a time is not above zero.
    """

    service_factor: float
    locked_rotor_current: float
    locked_rotor_time_s: float
    acceleration_factor: float = 1.0
    running_time_constant_s: float | None = None
    standstill_time_constant_s: float | None = None

    def __post_init__(self) -> None:
        if not 1.0 < self.service_factor < STARTING <= self.locked_rotor_current:
            raise ValueError(
                f"a thermal element needs 1 < service factor < {STARTING} <= locked-rotor current; "
                f"found {self.service_factor} and {self.locked_rotor_current}"
            )
        for name in (
            "locked_rotor_time_s",
            "acceleration_factor",
            "running_time_constant_s",
            "standstill_time_constant_s",
        ):
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and value > 0.0):
                raise ValueError(f"{name} must be above zero; found {value}")

    @property
    def resistance(self) -> float:
        """Thermal resistance R: heat at full-load current over its square [s]."""
        return OPERATING_HEAT * self.locked_rotor_current**2 * self.locked_rotor_time_s

    @property
    def rotor_trip_value(self) -> float:
        """Heat at which the relay trips while the motor starts."""
        share = self.acceleration_factor + OPERATING_HEAT
        return share * self.locked_rotor_current**2 * self.locked_rotor_time_s

    @property
    def stator_trip_value(self) -> float:
        """Heat at which the relay trips while the motor runs."""
        return self.resistance * self.service_factor**2

    @property
    def running_s(self) -> float:
        """Time constant while the motor runs [s].

        "Auto" makes the stator's model trip as late as the rotor's does at locked-rotor current (F.13).
        """
        if self.running_time_constant_s is not None:
            return self.running_time_constant_s
        locked, hot = self.locked_rotor_current**2, (HOT * self.service_factor) ** 2
        limit_s = (self.acceleration_factor + OPERATING_HEAT) * self.locked_rotor_time_s
        return limit_s / log((locked - hot) / (locked - self.service_factor**2))

    @property
    def standstill_s(self) -> float:
        """Time constant while the motor stands [s]."""
        if self.standstill_time_constant_s is not None:
            return self.standstill_time_constant_s
        return STANDSTILL * self.running_s


@dataclass(frozen=True, slots=True)
class RelayState:
    """State of the thermal element.

    Parameters
    ----------
    heat : float
        Heat estimate U.
    trip_value : float
        Heat at which the relay trips now.
    starting : bool
        Whether the rotor's model holds.
    """

    heat: float
    trip_value: float
    starting: bool

    @property
    def thermal_capacity_used(self) -> float:
        """Heat over the present trip value; at 1 the relay trips."""
        return self.heat / self.trip_value


def settings_of(element: ThermalElement) -> RelaySettings:
    """Return the settings of a thermal element as a motor's file has them.

    Parameters
    ----------
    element : ThermalElement
        The element.

    Returns
    -------
    RelaySettings
        Its settings.
    """
    return RelaySettings(
        element.service_factor,
        element.locked_rotor_current,
        element.locked_rotor_hot_s,
        element.acceleration_factor,
        element.running_time_constant_s,
        element.standstill_time_constant_s,
    )


def cold(settings: RelaySettings) -> RelayState:
    """Return the state of a motor at ambient temperature.

    Parameters
    ----------
    settings : RelaySettings
        Settings of the element.

    Returns
    -------
    RelayState
        The state.
    """
    return RelayState(0.0, settings.stator_trip_value, starting=False)


def warm(settings: RelaySettings) -> RelayState:
    """Return the state of a motor that has run at full-load current for long.

    Parameters
    ----------
    settings : RelaySettings
        Settings of the element.

    Returns
    -------
    RelayState
        The state.
    """
    return RelayState(settings.resistance, settings.stator_trip_value, starting=False)


def after(state: RelayState, steps: Iterable[CurrentStep], settings: RelaySettings) -> RelayState:
    """Return the state after currents have flowed.

    Parameters
    ----------
    state : RelayState
        State before.
    steps : iterable of CurrentStep
        The currents, in their order. Each may be of any length: the models are solved exactly.
    settings : RelaySettings
        Settings of the element.

    Returns
    -------
    RelayState
        State behind the last of them.
    """
    for step in steps:
        starting = step.positive > (STARTED if state.starting else STARTING)
        heated = step.positive**2 + step.negative**2
        if starting:
            heat = state.heat + heated * step.duration_s
            state = RelayState(heat, settings.rotor_trip_value, starting=True)
            continue
        heated = step.positive**2 + NEGATIVE_SEQUENCE_WHILE_RUNNING * step.negative**2
        lag_s = settings.standstill_s if step.is_standing else settings.running_s
        kept = exp(-step.duration_s / lag_s)
        end, trip = settings.resistance * heated, settings.stator_trip_value
        state = RelayState(
            end + (state.heat - end) * kept, trip + (state.trip_value - trip) * kept, starting=False
        )
    return state
