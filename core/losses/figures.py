"""What a record tells of a motor's losses."""

from dataclasses import dataclass, fields
from typing import Any, Self


@dataclass(frozen=True, slots=True)
class LossFigures:
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
    reasons: tuple[str, ...]

    @property
    def by_cause_W(self) -> dict[str, float]:
        """What faults and supply add to the losses, by cause in words; none where the losses are not told."""
        found = {
            "shorted turns": self.turns_loss_W,
            "unbalance of the supply": self.unbalance_loss_W,
            "voltage off its rated value": self.voltage_loss_W,
            "faulty cage": self.rotor_loss_W,
        }
        return {words: watts for words, watts in found.items() if watts is not None}

    @property
    def of_supply_W(self) -> dict[str, float]:
        """What the supply adds to the losses, by cause in words; faults of the motor have alarms."""
        causes = ("unbalance of the supply", "voltage off its rated value")
        return {words: watts for words, watts in self.extra_W.items() if words in causes}

    @property
    def extra_W(self) -> dict[str, float]:
        """Those of them that do add losses."""
        return {words: watts for words, watts in self.by_cause_W.items() if watts > 0.0}

    @classmethod
    def untold(cls, reason: str) -> Self:
        """Return the figures of a record that tells nothing.

        Parameters
        ----------
        reason : str
            Why, in words.

        Returns
        -------
        LossFigures
            Without figures.
        """
        untold: dict[str, Any] = {one.name: None for one in fields(cls)}
        return cls(**untold | {"reasons": (reason,)})

    def as_dict(self) -> dict[str, object]:
        """Return the part `losses` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name; tuples are lists.
        """
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}
