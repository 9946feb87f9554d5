"""Description of a motor: nameplate, equivalent-circuit parameters, channels, limits and sensors."""

from dataclasses import dataclass, field, fields
from enum import StrEnum
from math import pi, sqrt
from typing import Final, Self

from core.machines.deep_bars import DeepBars, LeakageSaturation, SeenRotor
from core.machines.sensors import SensorClass
from core.machines.stator_winding import StatorWinding
from core.table_layout import TableScaling

MAGNETISING_OVER_SELF: Final = 1.5
"""L_m / L_s: the magnetising inductance of three windings together over the self-inductance of one (thesis
3.14). An X_m of a data sheet is 2 pi f times L_m."""
USUAL_TOLERANCE: Final = 0.1
"""Parameters that were measured or commissioned are within 10 % of the motor's: windings warm up, data sheets
round off."""


FREQUENCIES_OF_RATED = (0.4, 2.4)
"""Range of a supply's frequency that is looked for, over the rated one: wider than any that is accepted, so
that a refusal can name what there is instead."""


class Connection(StrEnum):
    """How the windings are connected to the terminals."""

    STAR = "star"
    DELTA = "delta"


class MachineKind(StrEnum):
    """Kinds of induction motors, by their rotor."""

    CAGE = "cage"
    WOUND_ROTOR = "wound-rotor"
    """A rotor winding whose ends are on slip rings."""


class ParametersSource(StrEnum):
    """Where the parameters of a motor come from."""

    GIVEN = "given"
    COMMISSIONED = "commissioned"
    DATA_SHEET = "data-sheet"
    TYPICAL = "typical"
    """Of the rating: nothing but the nameplate is known of the motor."""


@dataclass(frozen=True, slots=True)
class Nameplate:
    """Rated values.

    Parameters
    ----------
    rated_power_W : float
        Power at the shaft [W].
    rated_voltage_V : float
        Voltage line to line, rms [V].
    rated_frequency_Hz : float
        Frequency of the supply [Hz].
    pole_pairs : int
        Number of pole pairs.
    connection : Connection, default Connection.STAR
        Star or delta.
    rotor_bars : int or None, optional
        Number of bars of the cage, or slots of a wound rotor; None where it is not known. Spectra are marked
        with it, and the speed is looked for with it.
    rated_speed_rpm : float or None, optional
        Speed at rated power [rpm], of a wound rotor with its rings shorted; None where it is not known.
    """

    rated_power_W: float
    rated_voltage_V: float
    rated_frequency_Hz: float
    pole_pairs: int
    connection: Connection = Connection.STAR
    rotor_bars: int | None = None
    rated_speed_rpm: float | None = None

    @property
    def synchronous_rpm(self) -> float:
        """Speed without slip at rated frequency [rpm]."""
        return 60.0 * self.rated_frequency_Hz / self.pole_pairs

    @property
    def rated_slip(self) -> float | None:
        """Slip at rated power; None where the plate's speed is not known."""
        return None if self.rated_speed_rpm is None else 1.0 - self.rated_speed_rpm / self.synchronous_rpm

    @property
    def frequency_range_Hz(self) -> tuple[float, float]:
        """Frequencies among which that of the supply is looked for [Hz]: 20 to 120 Hz for rated 50 Hz."""
        lowest, highest = FREQUENCIES_OF_RATED
        return lowest * self.rated_frequency_Hz, highest * self.rated_frequency_Hz

    @property
    def rated_angular_frequency(self) -> float:
        """Rated angular frequency w_b of the supply [rad/s]."""
        return 2 * pi * self.rated_frequency_Hz

    @property
    def rated_torque_Nm(self) -> float:
        """Torque that load level 1 stands for, P_B / (w_b / p), at synchronous speed [N m]."""
        return self.rated_power_W * self.pole_pairs / self.rated_angular_frequency

    @property
    def winding_voltage_V(self) -> float:
        """Rated voltage of a winding, rms [V]."""
        return self.rated_voltage_V / (sqrt(3.0) if self.connection is Connection.STAR else 1.0)

    @property
    def base_impedance_ohm(self) -> float:
        """Impedance of a winding that counts as one per unit: V^2 / P in star, 3 V^2 / P in delta [ohm]."""
        base = self.rated_voltage_V**2 / self.rated_power_W
        return 3.0 * base if self.connection is Connection.DELTA else base

    @property
    def base_inertia_kgm2(self) -> float:
        """Inertia whose constant H = J w_m^2 / (2 P) is one second [kg m^2]."""
        return 2.0 * self.rated_power_W / (self.rated_angular_frequency / self.pole_pairs) ** 2


@dataclass(frozen=True, slots=True)
class MachineParameters:
    """Parameters of a phase winding, referred to the stator; in delta they are those of the winding.

    Parameters
    ----------
    stator_resistance_ohm : float
        R_s [ohm].
    rotor_resistance_ohm : float
        R_r', referred to the stator [ohm].
    stator_leakage_H : float
        L_ls [H].
    rotor_leakage_H : float
        L_lr', referred to the stator [H].
    stator_self_inductance_H : float
        L_s of the thesis; the magnetising inductance is `MAGNETISING_OVER_SELF` L_s [H].
    inertia_kgm2 : float
        J of motor and load [kg m^2].
    """

    stator_resistance_ohm: float
    rotor_resistance_ohm: float
    stator_leakage_H: float
    rotor_leakage_H: float
    stator_self_inductance_H: float
    inertia_kgm2: float

    @property
    def magnetising_inductance_H(self) -> float:
        """Magnetising inductance L_m = 1.5 L_s [H] (thesis 3.14)."""
        return MAGNETISING_OVER_SELF * self.stator_self_inductance_H

    @classmethod
    def from_magnetising_inductance(
        cls,
        *,
        stator_resistance_ohm: float,
        rotor_resistance_ohm: float,
        stator_leakage_H: float,
        rotor_leakage_H: float,
        magnetising_inductance_H: float,
        inertia_kgm2: float,
    ) -> Self:
        """Return the parameters of a machine whose L_m is known, as data sheets have it.

        Parameters
        ----------
        stator_resistance_ohm, rotor_resistance_ohm : float
            R_s and R_r' [ohm].
        stator_leakage_H, rotor_leakage_H : float
            L_ls and L_lr' [H].
        magnetising_inductance_H : float
            L_m = X_m / (2 pi f) [H].
        inertia_kgm2 : float
            J of motor and load [kg m^2].

        Returns
        -------
        MachineParameters
            The parameters, with L_s = L_m / 1.5.
        """
        return cls(
            stator_resistance_ohm=stator_resistance_ohm,
            rotor_resistance_ohm=rotor_resistance_ohm,
            stator_leakage_H=stator_leakage_H,
            rotor_leakage_H=rotor_leakage_H,
            stator_self_inductance_H=magnetising_inductance_H / MAGNETISING_OVER_SELF,
            inertia_kgm2=inertia_kgm2,
        )


@dataclass(frozen=True, slots=True)
class ParameterTolerances:
    """How far the parameters of a motor may be off: shares either way, every error as likely as another.

    A wide one is the logarithm of a factor: 0.7 is half to twice the parameter.

    Parameters
    ----------
    stator_resistance_ohm, rotor_resistance_ohm : float, default 0.1
        Of R_s and R_r'.
    stator_leakage_H, rotor_leakage_H : float, default 0.1
        Of L_ls and L_lr'.
    stator_self_inductance_H : float, default 0.1
        Of L_s.
    """

    stator_resistance_ohm: float = USUAL_TOLERANCE
    rotor_resistance_ohm: float = USUAL_TOLERANCE
    stator_leakage_H: float = USUAL_TOLERANCE
    rotor_leakage_H: float = USUAL_TOLERANCE
    stator_self_inductance_H: float = USUAL_TOLERANCE

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Return the parameters that have one.

        Returns
        -------
        tuple of str
            Fields of `MachineParameters`.
        """
        return tuple(one.name for one in fields(cls))


@dataclass(frozen=True, slots=True)
class ChannelNames:
    """Names of the channels in the record; those not given are found by phase and unit.

    Parameters
    ----------
    currents : tuple of str or None, optional
        Channels of i_a, i_b, i_c.
    phase_voltages : tuple of str or None, optional
        Channels of v_a, v_b, v_c.
    line_voltages : tuple of str or None, optional
        Channels of v_ab, v_bc, v_ca.
    """

    currents: tuple[str, str, str] | None = None
    phase_voltages: tuple[str, str, str] | None = None
    line_voltages: tuple[str, str, str] | None = None


class CurrentPosition(StrEnum):
    """Where the current transformers sit."""

    LINE = "line"
    INSIDE_DELTA = "inside-delta"
    BEFORE_CAPACITORS = "before-capacitors"


@dataclass(frozen=True, slots=True)
class Transformers:
    """The instrument transformers: their place, and ratios that the recordings do not tell right.

    A ratio turns the values as the recording has them written into primary ones, and replaces what the
    recording itself says of ratio and side.

    Parameters
    ----------
    voltage_ratio : float or None, optional
        Primary over secondary voltage; 1 where the values are primary ones. None: as the recording says.
    current_ratio : float or None, optional
        The same of the currents.
    current_position : CurrentPosition, default LINE
        Whether they measure the line currents of the motor, those of the windings inside its delta, or those
        of the motor together with its power-factor capacitors.
    """

    voltage_ratio: float | None = None
    current_ratio: float | None = None
    current_position: CurrentPosition = CurrentPosition.LINE

    @property
    def inside_delta(self) -> bool:
        """Whether the currents are those of the windings inside the delta."""
        return self.current_position is CurrentPosition.INSIDE_DELTA


@dataclass(frozen=True, slots=True)
class Capacitors:
    """Power-factor capacitors that the relay's current transformers measure together with the motor.

    Parameters
    ----------
    kvar : float
        Reactive power of the whole bank at the motor's rated voltage and frequency [kvar].
    connection : Connection, default DELTA
        Star or delta.
    """

    kvar: float
    connection: Connection = Connection.DELTA


@dataclass(frozen=True, slots=True)
class Cable:
    """A cable between the voltage transformers and the motor.

    Parameters
    ----------
    resistance_ohm, reactance_ohm : float, default 0.0
        Of one line, at rated frequency [ohm].
    """

    resistance_ohm: float = 0.0
    reactance_ohm: float = 0.0


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of a motor's condition.

    Parameters
    ----------
    fault_level : float, default 0.005
        Level of shorted turns above which the motor counts as faulty, a fraction of the phase turns.
    """

    fault_level: float = 0.005
    """mu_f above which shorted turns are called a fault, fraction of the phase turns."""


@dataclass(frozen=True, slots=True)
class StartLimits:
    """What a motor's starts may do to it, as its data sheet says; None for what it does not say.

    Parameters
    ----------
    locked_rotor_current_A : float or None, optional
        Line current with the rotor locked at rated voltage, rms [A].
    locked_rotor_hot_s, locked_rotor_cold_s : float or None, optional
        Time for which the rotor withstands that current, from running temperature and from cold [s].
    starts_per_hour : int or None, optional
        Starts allowed within an hour.
    """

    locked_rotor_current_A: float | None = None
    locked_rotor_hot_s: float | None = None
    locked_rotor_cold_s: float | None = None
    starts_per_hour: int | None = None


@dataclass(frozen=True, slots=True)
class ThermalElement:
    """Settings of the relay's thermal element (49), as they stand in the relay.

    Parameters
    ----------
    service_factor : float
        SF, over the full-load current.
    locked_rotor_current : float
        LRA, over the full-load current.
    locked_rotor_hot_s : float
        LRTHOT, time a hot motor bears with its rotor locked [s].
    acceleration_factor : float, default 1.0
        TD, of that time.
    running_time_constant_s : float or None, optional
        RTC [s]; None for the relay's "Auto".
    standstill_time_constant_s : float or None, optional
        Time constant while the motor stands [s]; None for three times that of running.
    full_load_current_A : float or None, optional
        FLA, rms, primary [A]; None for that of the motor's circuit.
    """

    service_factor: float
    locked_rotor_current: float
    locked_rotor_hot_s: float
    acceleration_factor: float = 1.0
    running_time_constant_s: float | None = None
    standstill_time_constant_s: float | None = None
    full_load_current_A: float | None = None


@dataclass(frozen=True, slots=True)
class WoundRotor:
    """A rotor winding on slip rings, as its plate has it, and what is connected to the rings.

    Parameters
    ----------
    open_circuit_voltage_V : float
        Voltage between two open rings at standstill, rated voltage on the stator, rms [V].
    rated_current_A : float
        Current of a ring at rated power, rms [A].
    external_resistance_ohm : tuple of float, default (0.0, 0.0)
        Least and largest resistance between a ring and the star point while the motor runs [ohm]; the same
        twice where it is known, zero where the rings are shorted.
    """

    open_circuit_voltage_V: float
    rated_current_A: float
    external_resistance_ohm: tuple[float, float] = (0.0, 0.0)

    @property
    def standstill_impedance_ohm(self) -> float:
        """U_20 / (sqrt 3 I_2N), the resistance a phase that makes about rated torque at standstill [ohm]."""
        return self.open_circuit_voltage_V / (sqrt(3.0) * self.rated_current_A)


@dataclass(frozen=True, slots=True)
class Motor:
    """All that the diagnosis needs to know of one motor.

    Parameters
    ----------
    name : str
        Name of the motor.
    nameplate : Nameplate
        Rated values of the motor.
    parameters : MachineParameters
        Parameters of the machine.
    channels : ChannelNames, optional
        Names of the channels in the record.
    limits : Limits, optional
        Limits of the motor's condition.
    sensors : SensorClass, optional
        Class of the relay's channels with their transformers.
    transformers : Transformers, optional
        Ratios of the instrument transformers, where the recordings do not tell them right.
    parameters_source : ParametersSource, optional
        Where the parameters come from.
    tolerances : ParameterTolerances, optional
        How far they may be off.
    start_limits : StartLimits, optional
        What its starts may do to it.
    wound_rotor : WoundRotor or None, optional
        The rotor's winding; None of a motor with a cage.
    thermal : ThermalElement or None, optional
        Its relay's thermal element; None where the file does not tell it.
    winding : StatorWinding or None, optional
        How its stator is wound; None where the file does not tell it.
    deep_bars : DeepBars or None, optional
        How its rotor changes from a small slip to a great one; None where nothing tells that it does.
    leakage_saturation : LeakageSaturation or None, optional
        How its leakage falls at great currents; None where nothing tells that it does.
    tables : TableScaling, optional
        How tables of samples become amperes and volts.
    capacitors : Capacitors or None, optional
        Power-factor capacitors that are measured with it; None where the file tells of none.
    cable : Cable or None, optional
        Its cable, where the voltages are measured at the other end of one that matters.
    neutral : bool, default False
        Whether its star point is on the neutral, so that a fourth wire carries the sum of the currents.
    reads_leniently : bool, default False
        Whether faults of its relay's recordings are mended, and told, where that takes no guess at values.
    """

    name: str
    nameplate: Nameplate
    parameters: MachineParameters
    channels: ChannelNames = field(default_factory=ChannelNames)
    limits: Limits = field(default_factory=Limits)
    sensors: SensorClass = field(default_factory=SensorClass)
    transformers: Transformers = field(default_factory=Transformers)
    parameters_source: ParametersSource = ParametersSource.GIVEN
    tolerances: ParameterTolerances = field(default_factory=ParameterTolerances)
    start_limits: StartLimits = field(default_factory=StartLimits)
    wound_rotor: WoundRotor | None = None
    thermal: ThermalElement | None = None
    winding: StatorWinding | None = None
    deep_bars: DeepBars | None = None
    leakage_saturation: LeakageSaturation | None = None
    tables: TableScaling = field(default_factory=TableScaling)
    capacitors: Capacitors | None = None
    cable: Cable | None = None
    neutral: bool = False
    reads_leniently: bool = False

    @property
    def backward_rotor(self) -> SeenRotor:
        """The rotor as the negative sequence sees it, at about twice the frequency of the supply."""
        if self.deep_bars is None:
            return SeenRotor(1.0, 1.0)
        machine = self.parameters
        return self.deep_bars.seen_at(
            2.0 * self.nameplate.rated_angular_frequency,
            machine.rotor_resistance_ohm,
            machine.rotor_leakage_H,
        )

    @property
    def kind(self) -> MachineKind:
        """Its kind, which its rotor tells."""
        return MachineKind.CAGE if self.wound_rotor is None else MachineKind.WOUND_ROTOR

    @property
    def is_typical(self) -> bool:
        """Whether nothing but the nameplate is known, and the parameters are those of any such motor."""
        return self.parameters_source is ParametersSource.TYPICAL
