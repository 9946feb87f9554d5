"""What a start shows with the help of the motor's model: torque, load, parameters, and the rotor's cage."""

from dataclasses import asdict, dataclass
from math import hypot

from core.machines.parameters import MachineParameters
from core.normal_distribution import NORMAL_95
from core.rotor.start_finding import StartSideband
from core.starts.figures import MotorStart

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class StartTorque:
    """Torque and slip of a start.

    Parameters
    ----------
    first_s, step_s : float
        Time of the first point after the switching, and between two points [s].
    torque_Nm : tuple of float
        Torque of the air gap, means over one cycle or several [N m].
    speed : tuple of float or None
        Speed over the synchronous one at the same points; None in the first cycles.
    rated_torque_Nm : float
        Torque that load level 1 stands for [N m].
    impulse_Nms : float
        Integral of the torque over the run-up, or over as much of it as the record has [N m s].
    mean_torque_Nm : float
        Its mean over that time [N m].
    torque_at_rated_voltage_Nm : float
        That mean at rated voltage: torque goes with the square of the voltage [N m].
    momentum_Nms : float or None
        Inertia times the speed at the end of the run-up [N m s]; None where the record ends before.
    momentum_tolerance : float
        Share by which it may be off.
    load_torque_Nm : float or None
        Mean torque of the load during the run-up [N m].
    load_torque_Nm_ci95 : tuple of float or None
        Its 95 % interval, by the errors of sensors, resistance and inertia [N m].
    running_torque_Nm : float or None
        Torque once the motor runs [N m].
    """

    first_s: float
    step_s: float
    torque_Nm: tuple[float, ...]
    speed: tuple[float | None, ...]
    rated_torque_Nm: float
    impulse_Nms: float
    mean_torque_Nm: float
    torque_at_rated_voltage_Nm: float
    momentum_Nms: float | None
    momentum_tolerance: float
    load_torque_Nm: float | None
    load_torque_Nm_ci95: tuple[float, float] | None
    running_torque_Nm: float | None


@dataclass(frozen=True, slots=True)
class StartParameters:
    """Parameters by one start.

    Parameters
    ----------
    values : dict of str to float
        Values by the names of MachineParameters.
    ci95 : dict of str to tuple of float
        95 % intervals of those that the record tells; the others were held at the motor's.
    load_level : float
        Load torque over the rated one.
    load_level_ci95 : tuple of float or None
        Its 95 % interval.
    load_law : str
        How the load torque grows with speed.
    residual_share : float
        Share of the current that the model leaves unexplained.
    warnings : tuple of str
        Why the record may not be what it is taken for.
    """

    values: dict[str, float]
    ci95: dict[str, Interval]
    load_level: float
    load_level_ci95: Interval | None
    load_law: str
    residual_share: float
    warnings: tuple[str, ...]

    @property
    def machine(self) -> MachineParameters:
        """The parameters as the models take them."""
        return MachineParameters(**self.values)

    @property
    def rotor_over_stator(self) -> tuple[float, float] | None:
        """R_r' over R_s, and the standard deviation of its logarithm; None where not both are told."""
        values, spreads = [], []
        for name in ("rotor_resistance_ohm", "stator_resistance_ohm"):
            if name not in self.ci95 or not self.values[name] > 0.0:
                return None
            low, high = self.ci95[name]
            values.append(self.values[name])
            spreads.append((high - low) / (2.0 * NORMAL_95 * self.values[name]))
        return values[0] / values[1], hypot(*spreads)


@dataclass(frozen=True, slots=True)
class StartStress:
    """Heating of a start against the rotor's limit.

    Parameters
    ----------
    hot_limit_A2s, cold_limit_A2s : float or None
        I2t that the rotor withstands from running temperature and from cold [A^2 s]; None where not known.
    share_of_hot, share_of_cold : float or None
        I2t of the start over these limits; of a start that was recorded in part it is the least there was.
    source : str
        Where the limits come from.
    starts_per_hour : int or None
        Starts that the motor file allows within an hour.
    """

    hot_limit_A2s: float | None
    cold_limit_A2s: float | None
    share_of_hot: float | None
    share_of_cold: float | None
    source: str
    starts_per_hour: int | None


@dataclass(frozen=True, slots=True)
class ExaminedStart:
    """A start with all that it shows.

    Parameters
    ----------
    figures : MotorStart
        What the samples, or the relay's own report, show.
    torque : StartTorque or None
        Torque, speed and load; None where there are no voltages, or the start began before the record.
    parameters : StartParameters or None
        The motor's parameters by this start; None where they cannot be estimated.
    sideband : StartSideband or None
        What the start tells of the rotor's cage.
    stress : StartStress or None
        Its heating against what the rotor withstands.
    remark : str or None
        Why something of this is not known, in words.
    """

    figures: MotorStart
    torque: StartTorque | None = None
    parameters: StartParameters | None = None
    sideband: StartSideband | None = None
    stress: StartStress | None = None
    remark: str | None = None

    def model_as_dict(self) -> dict[str, object]:
        """Return what follows from the model as JSON takes it.

        Returns
        -------
        dict of str to object
            The parts torque, parameters, sideband, stress and remark; None for what is not known.
        """
        return {
            "torque": None if self.torque is None else asdict(self.torque),
            "parameters": None if self.parameters is None else asdict(self.parameters),
            "sideband": None if self.sideband is None else self.sideband.as_dict(),
            "stress": None if self.stress is None else asdict(self.stress),
            "remark": self.remark,
        }
