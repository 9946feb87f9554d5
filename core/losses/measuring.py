"""The losses of a motor in one record, segregated after IEC 60034-2-1.

Power drawn, currents and slip are measured; the resistances are those of the motor's file, half way between
cold and hot; the rest is what motors of the rating lose. Each of these is uncertain by itself; the interval
holds them all. A gain of the sensors changes power drawn and losses alike: the efficiency hardly.
"""

from dataclasses import dataclass, replace
from math import exp, hypot, log, sqrt

from core.condition.measuring.turns_grid import HALF_WARM
from core.diagnosis.verdict import Diagnosis
from core.losses.extra import (
    backward_rotor_ohm,
    losses_of_cage,
    losses_of_turns,
    losses_of_unbalance,
    losses_of_voltage,
)
from core.losses.figures import LossFigures
from core.losses.other_losses import OtherLosses, other_losses
from core.machines.parameters import Connection, Motor
from core.normal_distribution import NORMAL_95
from core.rotor.finding import RotorFinding, load_bin
from core.speed.finding import SpeedFinding
from core.supply.figures import SupplyFigures

WARMTH_DEVIATION = 0.06
"""Standard deviation of a winding's resistance by its temperature, relative."""
MOST_LOSSES = 0.6
"""Of the power drawn: a motor that loses more is not one of this file, or runs without a load."""


@dataclass(frozen=True, slots=True)
class _Segregated:
    stator_copper_W: float
    rotor_copper_W: float
    iron_W: float
    friction_W: float
    stray_W: float

    @property
    def total_W(self) -> float:
        return self.stator_copper_W + self.rotor_copper_W + self.iron_W + self.friction_W + self.stray_W


@dataclass(frozen=True, slots=True)
class _Measured:
    """What a record tells: power [W], currents of the windings [A], voltage over rated, heat of turns [W]."""

    power_W: float
    current_A: float
    backward_current_A: float
    slip: float
    voltage: float
    turns_W: float

    def segregated(self, motor: Motor, other: OtherLosses) -> _Segregated:
        """Return the losses: of the forward field, and what the backward one adds to the rotor's."""
        stator_W = 3.0 * motor.parameters.stator_resistance_ohm * self.current_A**2 + self.turns_W
        iron_W = other.iron_W * self.voltage**2
        backward_W = 3.0 * backward_rotor_ohm(motor) * self.backward_current_A**2
        crossing_W = self.power_W - stator_W - iron_W - backward_W / (2.0 - self.slip)
        return _Segregated(
            stator_copper_W=stator_W,
            rotor_copper_W=self.slip * max(crossing_W, 0.0) + backward_W,
            iron_W=iron_W,
            friction_W=other.friction_W,
            stray_W=other.stray_at(self.current_A),
        )


def measure_losses(
    motor: Motor,
    diagnosis: Diagnosis,
    supply: SupplyFigures | None,
    rotor: RotorFinding,
    speed: SpeedFinding,
) -> LossFigures:
    """Tell the losses of a motor, its efficiency, and what of them its faults and its supply cost.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    diagnosis : Diagnosis
        What the record shows of the stator.
    supply : SupplyFigures or None
        What it shows of the supply; None where it shows nothing.
    rotor : RotorFinding
        What it shows of the cage.
    speed : SpeedFinding
        The speed of the shaft.

    Returns
    -------
    LossFigures
        The figures; their reasons say why there are none.
    """
    if diagnosis.currents_only:
        return LossFigures.untold("no voltages recorded: the power drawn is not known")
    if supply is None or supply.active_power_W is None or supply.line_currents_A is None:
        return LossFigures.untold("the record shows no power drawn from the supply")
    if speed.slip is None or diagnosis.indicators is None:
        return LossFigures.untold("the record shows no slip of a motor that runs steadily")
    if supply.active_power_W <= 0.0 or speed.slip <= 0.0:
        return LossFigures.untold("the motor feeds power back")
    motor = _at_work(motor)
    in_winding = 1.0 / sqrt(3.0) if motor.nameplate.connection is Connection.DELTA else 1.0
    seen = speed.seen_slip is not None
    slip = speed.slip * (1.0 if seen else HALF_WARM)
    turns = losses_of_turns(motor, diagnosis, supply, slip)
    measured = _Measured(
        power_W=supply.active_power_W,
        current_A=in_winding * sqrt(sum(one * one for one in supply.line_currents_A) / 3.0),
        backward_current_A=in_winding * diagnosis.indicators.negative_sequence_current_A,
        slip=slip,
        voltage=1.0 + supply.voltage_deviation,
        turns_W=turns.path_W,
    )
    parts = measured.segregated(motor, other_losses(motor))
    losses_W = parts.total_W
    if losses_W > MOST_LOSSES * measured.power_W:
        return LossFigures.untold(
            f"losses of {losses_W / measured.power_W:.0%} of the power drawn: the motor runs idle, or its "
            "parameters are not its own"
        )
    deviation = _deviation(motor, measured, speed, diagnosis.mu_f_ci95)
    low_W, high_W = (losses_W * exp(sign * NORMAL_95 * deviation) for sign in (-1.0, 1.0))
    output_W = measured.power_W - losses_W
    reasons = () if seen else ("the slip is that of the model, by the rotor resistance of the motor's file",)
    return LossFigures(
        efficiency=output_W / measured.power_W,
        efficiency_ci95=(max(0.0, 1.0 - high_W / measured.power_W), 1.0 - low_W / measured.power_W),
        output_W=output_W,
        load_class=load_bin(output_W / motor.nameplate.rated_power_W),
        losses_W=losses_W,
        losses_W_ci95=(low_W, high_W),
        stator_copper_W=parts.stator_copper_W,
        rotor_copper_W=parts.rotor_copper_W,
        iron_W=parts.iron_W,
        friction_W=parts.friction_W,
        stray_W=parts.stray_W,
        turns_loss_W=sum(turns),
        unbalance_loss_W=losses_of_unbalance(motor, supply, slip),
        voltage_loss_W=losses_of_voltage(motor, supply, measured.power_W),
        rotor_loss_W=losses_of_cage(rotor, parts.rotor_copper_W),
        reasons=reasons,
    )


def _deviation(
    motor: Motor, measured: _Measured, speed: SpeedFinding, level_ci95: tuple[float, float] | None
) -> float:
    """Return the standard deviation of the logarithm of the losses, by what each uncertainty changes."""
    middle_W = measured.segregated(motor, other_losses(motor)).total_W
    warmer = _with_resistance(motor, "stator_resistance_ohm")
    slower = _with_resistance(motor, "rotor_resistance_ohm")
    is_seen = speed.seen_slip is not None
    ratio = slower.parameters.rotor_resistance_ohm / motor.parameters.rotor_resistance_ohm
    slipping = replace(measured, slip=measured.slip * (1.0 if is_seen else ratio))
    seen = replace(measured, slip=measured.slip * exp(_seen_slip_deviation(measured.slip, speed)))
    changed_W = (
        measured.segregated(warmer, other_losses(warmer)).total_W,
        slipping.segregated(slower, other_losses(slower)).total_W,
        seen.segregated(motor, other_losses(motor)).total_W,
        measured.segregated(motor, other_losses(motor, 1.0)).total_W,
        middle_W + _level_deviation(level_ci95) * measured.turns_W,
    )
    return hypot(*(log(one / middle_W) for one in changed_W))


def _at_work(motor: Motor) -> Motor:
    """Return a motor whose resistances are half way between cold, as its file may have them, and hot."""
    return _warmed(_warmed(motor, "stator_resistance_ohm", HALF_WARM), "rotor_resistance_ohm", HALF_WARM)


def _with_resistance(motor: Motor, name: str) -> Motor:
    """Return the motor with a resistance that is larger by its standard deviation: tolerance and warmth."""
    deviation = hypot(getattr(motor.tolerances, name) / sqrt(3.0), WARMTH_DEVIATION)
    return _warmed(motor, name, exp(deviation))


def _warmed(motor: Motor, name: str, factor: float) -> Motor:
    value = factor * getattr(motor.parameters, name)
    return replace(motor, parameters=replace(motor.parameters, **{name: value}))


def _level_deviation(ci95: tuple[float, float] | None) -> float:
    """Return the relative standard deviation of a fault level."""
    if ci95 is None or ci95[0] <= 0.0:
        return 1.0
    return log(ci95[1] / ci95[0]) / (2.0 * NORMAL_95)


def _seen_slip_deviation(slip: float, speed: SpeedFinding) -> float:
    """Return the standard deviation of the logarithm of a slip that is seen; zero of one by the model."""
    if speed.seen_slip is None or speed.speed_rpm_ci95 is None or speed.speed_rpm is None:
        return 0.0
    low_rpm, high_rpm = speed.speed_rpm_ci95
    synchronous_rpm = speed.speed_rpm / (1.0 - slip)
    return (high_rpm - low_rpm) / (2.0 * NORMAL_95 * slip * synchronous_rpm)
