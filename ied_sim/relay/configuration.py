"""What one simulated relay is given: its motor, kind and settings, what it does wrong, whom it lets in."""

from dataclasses import asdict, dataclass, field
from math import degrees
from zoneinfo import ZoneInfo

from ied_sim.misbehaviour import Misbehaviour
from ied_sim.motor.fault import TurnFault
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import CHANNELS
from ied_sim.profiles.profile import Profile, Triggers
from ied_sim.relay.event_recorder import RecorderSettings
from ied_sim.relay.protection import ProtectionSettings
from mms import TlsConfiguration

LOAD_PROFILE_S = 60.0


@dataclass(frozen=True, slots=True)
class Access:
    """What a client must show; nothing by default."""

    tls: TlsConfiguration | None = None
    passwords: tuple[str, ...] = field(default=(), repr=False)


@dataclass(frozen=True, slots=True)
class RelayConfiguration:
    """Configuration of one relay.

    Parameters
    ----------
    plant : MotorPlant
        The motor it protects.
    profile : Profile
        What kind of relay it is.
    recorder : RecorderSettings
        What a record spans, and how many are kept.
    triggers : Triggers
        What makes a record besides the controls.
    protection : ProtectionSettings
        Protection elements in use.
    misbehaviour : tuple of Misbehaviour
        What the relay or its network does wrong.
    load_profile_s : float
        Time between rows of the load profile.
    access : Access
        What a client must show.
    metering_period_s : float
        Time between updates of the metered values.
    metering_refresh_s : float
        Longest time until unchanged values are published again.
    time_zone : zoneinfo.ZoneInfo or None
        Zone in which records and reports have their times; None for UTC.
    """

    plant: MotorPlant
    profile: Profile
    recorder: RecorderSettings
    triggers: Triggers = field(default_factory=Triggers)
    protection: ProtectionSettings = field(default_factory=ProtectionSettings)
    misbehaviour: tuple[Misbehaviour, ...] = ()
    load_profile_s: float = LOAD_PROFILE_S
    access: Access = field(default_factory=Access)
    metering_period_s: float = 1.0
    metering_refresh_s: float = 30.0
    time_zone: ZoneInfo | None = None

    def truth(self, time_s: float) -> dict[str, object]:
        """Return the motor's true condition at a time since the scenario's beginning.

        It is whether it runs, mu_f (the equivalent level), theta_f, the coil and its axis, load_level,
        joint_ohm, the number of broken bars and of all, eccentricities, the load's pulsations, and of
        channels that have changed by then how much their gain errors and delays have.
        """
        plant = self.plant
        parameters = plant.motor.parameters
        fault = None if plant.fault is None else plant.fault.at(time_s)
        level = 0.0 if fault is None else fault.equivalent_level(parameters.stator_resistance_ohm)
        contactor = plant.contactor
        return {
            "running": contactor is None or contactor.closure_at(time_s) is not None,
            "mu_f": round(level, 12),
            "theta_f": fault.phase if fault is not None and level > 0 else None,
            **_in_coil(plant, fault),
            "load_level": plant.load.level_at(time_s),
            "joint_ohm": 0.0 if plant.joint is None else plant.joint.resistance_ohm(time_s),
            "broken_bars": plant.broken_share(time_s) * plant.cage.bars,
            "bars": plant.cage.bars,
            **_at_slip_rings(plant, time_s),
            "eccentricity": asdict(plant.eccentricity),
            "pulsations": [
                {name: value for name, value in asdict(pulsation).items() if value}
                for pulsation in plant.load.pulsations
            ],
            "channels": {
                name: {"gain": gain, "delay_us": delay_s * 1e6}
                for name, (gain, delay_s) in zip(CHANNELS, plant.sensors.changed(time_s), strict=True)
                if gain or delay_s
            },
        }


def _in_coil(plant: MotorPlant, fault: TurnFault | None) -> dict[str, object]:
    """Return the coil of a fault in a winding by slots, and how far its axis lies from the phase's."""
    if fault is None or fault.coil is None or plant.winding is None:
        return {}
    axis = plant.winding.axis_rad(plant.motor.nameplate.pole_pairs, fault.coil)
    return {"coil": fault.coil, "coil_axis_deg": round(degrees(axis), 6)}


def _at_slip_rings(plant: MotorPlant, time_s: float) -> dict[str, object]:
    """Return the resistances at the slip rings of a wound rotor, of its own turns."""
    rings = plant.slip_rings
    if rings is None:
        return {}
    return {"external_rotor_ohm": rings.outside_ohm(time_s), "rotor_contacts_ohm": list(rings.contacts_ohm)}
