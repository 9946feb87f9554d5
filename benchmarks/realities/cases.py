"""What plants do to a record of a motor: each a change of a simulated plant, and of what its file says.

Each is drawn by a seed: size, phase and place. `named` is what the reasons of a record must hold that names
the reality; where it is empty there is nothing to name, and the record is to be judged as any other.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Cable as KnownCable
from core.machines.parameters import Capacitors as KnownBank
from core.machines.parameters import Connection, CurrentPosition, Motor
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.feeder import Cable, Capacitors, Feeder, Heater, OtherMotor
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.saturation import EXPONENT, MainSaturation
from ied_sim.motor.supply import Harmonic, SupplyEvent

Array = NDArray[np.float64]
Random = np.random.Generator
RATE_HZ, DURATION_S = 4_000.0, 0.5
CYCLE_S = 0.02


@dataclass(frozen=True, slots=True)
class Reality:
    """One reality.

    plant: changes the plant.  file: changes what the motor's file says.  samples: makes the record of another
    plant than by simulating its window.  named: regular expression of its name.  connection: star or delta
    where only one has it.
    """

    name: str
    plant: Callable[[MotorPlant, Random], MotorPlant] = lambda plant, _random: plant
    file: Callable[[Motor, MotorPlant], Motor] = lambda motor, _plant: motor
    samples: Callable[[MotorPlant, Random], Array] = lambda plant, _random: window(plant)
    named: str = ""
    connection: Connection | None = None
    duration_s: float = DURATION_S


def window(plant: MotorPlant, duration_s: float = DURATION_S) -> Array:
    """Samples of a record."""
    return plant.window(0.0, duration_s, RATE_HZ)


def magnetising_kvar(motor: Motor) -> float:
    """Reactive power without load at rated voltage [kvar]."""
    plate, machine = motor.nameplate, motor.parameters
    L = machine.magnetising_inductance_H + machine.stator_leakage_H
    return 3e-3 * plate.winding_voltage_V**2 / (plate.rated_angular_frequency * L)


def _bank(share: float, lost: float = 0.0) -> Callable[[MotorPlant, Random], MotorPlant]:
    def connected(plant: MotorPlant, random: Random) -> MotorPlant:
        connection = Connection.DELTA if random.integers(2) else Connection.STAR
        kvar = share * magnetising_kvar(plant.motor)
        bank = Capacitors(kvar, connection, int(random.integers(3)), ((0.0, lost),))
        return replace(plant, feeder=replace(plant.feeder, capacitors=bank))

    return connected


def _knows_bank(motor: Motor, plant: MotorPlant) -> Motor:
    bank = plant.feeder.capacitors
    return motor if bank is None else replace(motor, capacitors=KnownBank(bank.kvar, bank.connection))


def _heater(share: float, *, single: bool = False) -> Callable[[MotorPlant, Random], MotorPlant]:
    """A heater whose current is a share of the rated one."""

    def connected(plant: MotorPlant, random: Random) -> MotorPlant:
        line, amps = int(random.integers(3)), share * rated_current(plant.motor)
        volts = plant.motor.nameplate.rated_voltage_V / (sqrt(3.0) if single else 1.0)
        heater = Heater(amps * volts, line, None if single else (line + 1) % 3)
        return replace(plant, feeder=replace(plant.feeder, heaters=(heater,)))

    return connected


def _cable(plant: MotorPlant, random: Random) -> MotorPlant:
    """A drop of 5 % at rated current, at any angle from resistive to equal parts."""
    plate = plant.motor.nameplate
    ohm = 0.05 * plate.rated_voltage_V / sqrt(3.0) / rated_current(plant.motor)
    angle = random.uniform(0.0, np.pi / 4)
    return replace(plant, feeder=Feeder(cable=Cable(ohm * float(np.cos(angle)), ohm * float(np.sin(angle)))))


def _knows_cable(motor: Motor, plant: MotorPlant) -> Motor:
    cable = plant.feeder.cable
    return replace(motor, cable=KnownCable(cable.resistance_ohm, cable.reactance_ohm))


def _saturated(voltage: float) -> Callable[[MotorPlant, Random], MotorPlant]:
    """A main inductance that loses 8 to 20 % at 110 % of the rated voltage."""

    def fed(plant: MotorPlant, random: Random) -> MotorPlant:
        loss = random.uniform(0.08, 0.20)
        iron = MainSaturation(loss / (1.0 - loss) / (1.1 ** (EXPONENT - 1.0) - 1.0))
        volts = voltage * plant.motor.nameplate.rated_voltage_V
        return replace(plant, main_saturation=iron, supply=replace(plant.supply, line_voltage_V=volts))

    return fed


def _late_channel(plant: MotorPlant, random: Random) -> MotorPlant:
    delays, channel = list(plant.sensors.delays_s), 3 + int(random.integers(3))
    delays[channel] += 100e-6
    return replace(plant, sensors=replace(plant.sensors, delays_s=tuple(delays)))


def _joint(plant: MotorPlant, random: Random) -> MotorPlant:
    plate = plant.motor.nameplate
    ohm = 0.04 * plate.rated_voltage_V / sqrt(3.0) / rated_current(plant.motor)
    return replace(plant, joint=JointCourse(int(random.integers(3)), ((0.0, ohm),)))


def _two_motors(plant: MotorPlant, random: Random) -> MotorPlant:
    other = OtherMotor(plant.motor, Load(float(random.uniform(0.2, 1.0))))
    return replace(plant, feeder=Feeder(other_motor=other))


def _inside(plant: MotorPlant, _random: Random) -> MotorPlant:
    return replace(plant, feeder=Feeder(inside_delta=True))


def _knows_inside(motor: Motor, _plant: MotorPlant) -> Motor:
    return replace(
        motor, transformers=replace(motor.transformers, current_position=CurrentPosition.INSIDE_DELTA)
    )


def _neutral(third: float) -> Callable[[MotorPlant, Random], MotorPlant]:
    def connected(plant: MotorPlant, random: Random) -> MotorPlant:
        harmonics = (*plant.supply.harmonics, Harmonic(3, third, float(random.uniform(0.0, 6.0))))
        return replace(plant, feeder=Feeder(neutral=True), supply=replace(plant.supply, harmonics=harmonics))

    return connected


def _knows_neutral(motor: Motor, _plant: MotorPlant) -> Motor:
    return replace(motor, neutral=True)


def _loaded(level: float) -> Callable[[MotorPlant, Random], MotorPlant]:
    return lambda plant, _random: replace(plant, load=replace(plant.load, level=level))


def _pulsating(pulsation: Pulsation) -> Callable[[MotorPlant, Random], MotorPlant]:
    return lambda plant, _random: replace(
        plant, load=replace(plant.load, level=max(plant.load.level, 0.5), pulsations=(pulsation,))
    )


def _dip(plant: MotorPlant, _random: Random) -> MotorPlant:
    event = SupplyEvent(DURATION_S * 0.5, 0.1, 0.9)
    return replace(plant, supply=replace(plant.supply, events=(event,)))


def _stop(plant: MotorPlant, _random: Random) -> MotorPlant:
    return replace(plant, contactor=Contactor(opens_s=DURATION_S - 0.012))


def _fuse(plant: MotorPlant, _random: Random) -> Array:
    """A fuse of one line blows after two thirds of the record; the transient behind it is left out."""
    plate = plant.motor.nameplate
    ohm = 30.0 * plate.rated_voltage_V / sqrt(3.0) / rated_current(plant.motor)
    before, behind = window(plant), window(replace(plant, joint=JointCourse(1, ((0.0, ohm),))))
    blown = int(before.shape[1] * 2 / 3)
    return np.concatenate((before[:, :blown], behind[:, blown:]), axis=1)


def _in_star(plant: MotorPlant, _random: Random) -> MotorPlant:
    motor = plant.motor
    star = replace(motor, nameplate=replace(motor.nameplate, connection=Connection.STAR))
    return replace(plant, motor=star, load=replace(plant.load, level=min(plant.load.level, 0.5) / 2))


STAR, DELTA = Connection.STAR, Connection.DELTA
STEADY = (
    Reality("nothing else"),
    Reality("110 % voltage, iron saturates", _saturated(1.1)),
    Reality("90 % voltage, iron saturates", _saturated(0.9)),
    Reality("capacitors, 40 % of the magnetising kvar", _bank(0.4), named="apacitors"),
    Reality("capacitors, 90 % of the magnetising kvar", _bank(0.9), named="apacitors"),
    Reality("capacitors of 90 %, in the file", _bank(0.9), _knows_bank),
    Reality("capacitors of 40 %, a branch lost", _bank(0.4, 1.0), named="apacitor"),
    Reality("capacitors of 40 %, in the file, a branch lost", _bank(0.4, 1.0), _knows_bank, named="apacitor"),
    Reality("capacitors of 90 %, a branch lost", _bank(0.9, 1.0), named="apacitor"),
    Reality("capacitors of 90 %, in the file, a branch lost", _bank(0.9, 1.0), _knows_bank, named="apacitor"),
    Reality("two-phase load of 6 % of the rated current", _heater(0.06), named="load behind|between lines"),
    Reality("two-phase load of 12 %", _heater(0.12), named="load behind|between lines"),
    Reality("two-phase load of 25 %", _heater(0.25), named="load behind|between lines"),
    Reality("single-phase load of 6 %", _heater(0.06, single=True), named="load behind|neutral"),
    Reality("one voltage filter late by 100 us", _late_channel, named="voltage channel"),
    Reality("a joint of 4 %", _joint, named="high-resistance connection"),
    Reality("cable of 5 %", _cable),
    Reality("cable of 5 %, in the file", _cable, _knows_cable),
    Reality("two motors behind the relay", _two_motors, named="two motors"),
    Reality("transformers inside the delta", _inside, named="inside.the.delta", connection=DELTA),
    Reality("transformers inside the delta, in the file", _inside, _knows_inside, connection=DELTA),
    Reality("star point on the neutral", _neutral(0.0), named="neutral", connection=STAR),
    Reality("on the neutral, third harmonic of 2 %", _neutral(0.02), named="neutral", connection=STAR),
    Reality("on the neutral, third harmonic, in the file", _neutral(0.02), _knows_neutral, connection=STAR),
)
OTHER_RUNNING = (
    Reality("drives the supply at half load", _loaded(-0.5), named="generat"),
    Reality("drives the supply at full load", _loaded(-1.0), named="generat"),
    Reality("a star-delta starter stays in star", _in_star, named="in star", connection=DELTA),
    Reality("stops 12 ms before the end", _stop, named="switched off"),
    Reality("a dip of 10 % in the middle", _dip, named="dip"),
    Reality("a fuse blows after two thirds", samples=_fuse, named="fuse|opens"),
    Reality(
        "compressor, 50 % pulsation once a turn",
        _pulsating(Pulsation(0.5, per_turn=1.0)),
        named="swing|pulsat",
    ),
    Reality(
        "compressor, 50 %, every second turn", _pulsating(Pulsation(0.5, per_turn=0.5)), named="swing|pulsat"
    ),
    Reality(
        "hammer, 40 % at 3 Hz",
        _pulsating(Pulsation(0.4, frequency_Hz=3.0)),
        named="swing|pulsat",
        duration_s=1.0,
    ),
)
REALITIES = (*STEADY, *OTHER_RUNNING)
