"""What is known of a motor: nameplate, equivalent-circuit parameters, channels of its recordings, limits."""

from dataclasses import dataclass, field
from enum import StrEnum
from math import pi


class Connection(StrEnum):
    STAR = "star"
    DELTA = "delta"


@dataclass(frozen=True, slots=True)
class Nameplate:
    """Rated values. `rated_voltage_V` is line to line, rms."""

    rated_power_W: float
    rated_voltage_V: float
    rated_frequency_Hz: float
    pole_pairs: int
    connection: Connection = Connection.STAR

    @property
    def rated_angular_frequency(self) -> float:
        """w_b, electrical [rad/s]."""
        return 2 * pi * self.rated_frequency_Hz

    @property
    def rated_torque_Nm(self) -> float:
        """P_B / (w_b / p): the torque that load level 1 stands for, at synchronous speed [N m]."""
        return self.rated_power_W * self.pole_pairs / self.rated_angular_frequency


@dataclass(frozen=True, slots=True)
class MachineParameters:
    """Per-phase (winding) parameters referred to the stator; in delta they are those of the winding.

    stator_self_inductance_H is the thesis's L_s: the magnetising inductance is L_m = 1.5 L_s.
    """

    stator_resistance_ohm: float
    rotor_resistance_ohm: float
    stator_leakage_H: float
    rotor_leakage_H: float
    stator_self_inductance_H: float
    inertia_kgm2: float

    @property
    def magnetising_inductance_H(self) -> float:
        """L_m = 1.5 L_s [H] (thesis 3.14)."""
        return 1.5 * self.stator_self_inductance_H


@dataclass(frozen=True, slots=True)
class ChannelNames:
    """Names of the channels in the record; empty ones are found by phase and unit."""

    currents: tuple[str, str, str] | None = None
    phase_voltages: tuple[str, str, str] | None = None
    line_voltages: tuple[str, str, str] | None = None


@dataclass(frozen=True, slots=True)
class Limits:
    """Where a motor's condition becomes somebody's business."""

    fault_level: float = 0.005
    """mu_f above which shorted turns are called a fault, fraction of the phase turns."""


@dataclass(frozen=True, slots=True)
class Motor:
    """All the diagnosis needs to know of one motor."""

    name: str
    nameplate: Nameplate
    parameters: MachineParameters
    channels: ChannelNames = field(default_factory=ChannelNames)
    limits: Limits = field(default_factory=Limits)
