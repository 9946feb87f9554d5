"""What a record tells of a motor's losses."""

from dataclasses import dataclass
from enum import StrEnum

from core.reasoned_figures import ReasonedFigures


class LossCause(StrEnum):
    """What adds to the losses of a motor, in words."""

    TURNS = "shorted turns"
    UNBALANCE = "unbalance of the supply"
    VOLTAGE = "voltage off its rated value"
    CAGE = "faulty cage"

    @property
    def is_of_supply(self) -> bool:
        """Whether it is none of the motor, whose own faults have alarms of their own."""
        return self in (LossCause.UNBALANCE, LossCause.VOLTAGE)


@dataclass(frozen=True, slots=True)
class LossFigures(ReasonedFigures):
    """Losses of a motor in one record; figures are None where it cannot tell them.

    Parameters
    ----------
    efficiency : float or None
        Power at the shaft over power drawn.
    efficiency_ci95 : tuple of float or None
        Its 95 % interval: resistances, slip, and the losses that no current tells.
    output_W : float or None
        Power at the shaft [W].
    load_class : int or None
        Tenth of the rated power at the shaft, 0 to 11: efficiencies compare within one.
    losses_W : float or None
        All losses [W].
    losses_W_ci95 : tuple of float or None
        Their 95 % interval [W].
    stator_copper_W, rotor_copper_W : float or None
        In the windings of the stator with their shorted turns, and in the rotor [W].
    iron_W, friction_W, stray_W : float or None
        In the core, by friction and windage, and stray load losses [W].
    turns_loss_W : float or None
        What shorted turns cost; zero where none are found [W].
    unbalance_loss_W : float or None
        What the unbalance of the supply costs [W].
    voltage_loss_W : float or None
        What it costs that the voltage is not the rated one; below zero where that saves [W].
    rotor_loss_W : float or None
        What a faulty cage costs; zero where none is found [W].
    reasons : tuple of str
        What limits the figures, in words.
    """

    efficiency: float | None
    efficiency_ci95: tuple[float, float] | None
    output_W: float | None
    load_class: int | None
    losses_W: float | None
    losses_W_ci95: tuple[float, float] | None
    stator_copper_W: float | None
    rotor_copper_W: float | None
    iron_W: float | None
    friction_W: float | None
    stray_W: float | None
    turns_loss_W: float | None
    unbalance_loss_W: float | None
    voltage_loss_W: float | None
    rotor_loss_W: float | None

    @property
    def by_cause_W(self) -> dict[LossCause, float]:
        """What faults and supply add to the losses, by cause; none where the losses are not told."""
        found = {
            LossCause.TURNS: self.turns_loss_W,
            LossCause.UNBALANCE: self.unbalance_loss_W,
            LossCause.VOLTAGE: self.voltage_loss_W,
            LossCause.CAGE: self.rotor_loss_W,
        }
        return {cause: watts for cause, watts in found.items() if watts is not None}

    @property
    def extra_W(self) -> dict[LossCause, float]:
        """Those of them that do add losses."""
        return {cause: watts for cause, watts in self.by_cause_W.items() if watts > 0.0}
