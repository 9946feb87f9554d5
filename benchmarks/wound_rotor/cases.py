"""Records of motors with a wound rotor, and what examination makes of them.

The physics is the simulator's: three rotor coils with a resistance of their own each. The examination knows
every parameter with an error of up to ten percent and relays with errors of their class.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from core.findings.examining import examine
from core.findings.findings import Findings
from core.machines.parameters import Motor, ParameterTolerances, WoundRotor
from ied_sim.motor.load import Pulsation
from testing.machines.wound_rotors import HOIST, MILL, WoundRotorCase

MOTORS = {"hoist": HOIST, "mill": MILL}
"""37 kW at 400 V, and 500 kW at 6 kV."""
Knowledge = Literal["shorted", "unknown"]
"""What the motor file says of the rings."""
LARGEST_SHARE = 0.2
"""Of an unknown resistance, over that of rated torque at standstill."""
DURATION_S = 4.0


@dataclass(frozen=True, slots=True)
class Subject:
    """One record. external_share: over the resistance of rated torque at standstill.

    contact_share: what one rotor phase has more, over the resistance of the phase's circuit.
    """

    motor: str
    load_level: float
    external_share: float
    knowledge: Knowledge
    seed: int
    level: float = 0.0
    contact_share: float = 0.0
    swing: float = 0.0


@dataclass(frozen=True, slots=True)
class Result:
    """What was found beside what is true; slip: the simulated one."""

    subject: Subject
    phase: int
    slip: float
    external_ohm: float
    found: Findings


def examined(subject: Subject) -> Result:
    """Simulate one record and examine it."""
    random = np.random.default_rng(
        [subject.seed, round(1e3 * subject.level), round(100 * subject.load_level), *subject.motor.encode()]
    )
    motor = MOTORS[subject.motor]
    rotor = rotor_of(motor)
    external_ohm = subject.external_share * rotor.standstill_impedance_ohm
    ratio = 3.0 * motor.nameplate.winding_voltage_V**2 / rotor.open_circuit_voltage_V**2
    phase_ohm = motor.parameters.rotor_resistance_ohm / ratio + external_ohm
    case = WoundRotorCase(
        motor,
        load_level=subject.load_level,
        external_ohm=external_ohm,
        contacts_ohm=(subject.contact_share * phase_ohm, 0.0, 0.0),
        level=subject.level,
        phase=int(random.integers(3)),
        unbalance=random.uniform(0.0, 0.01),
        unbalance_angle_rad=random.uniform(0.0, 2.0 * np.pi),
        noise=random.uniform(0.001, 0.005),
        seed=int(random.integers(1 << 30)),
        gain_errors=tuple(random.uniform(-0.005, 0.005, 6)),
        pulsations=_pulsations(subject, random),
    )
    known = _wrong(motor, random)
    if subject.knowledge == "unknown":
        span = (0.0, LARGEST_SHARE * rotor.standstill_impedance_ohm)
        known = replace(known, wound_rotor=replace(rotor, external_resistance_ohm=span))
    record = case.record(DURATION_S)
    return Result(
        subject, case.phase, case.slip(), external_ohm + case.contacts_ohm[0] / 3.0, examine(record, known)
    )


def rotor_of(motor: Motor) -> WoundRotor:
    """The rotor's winding."""
    assert motor.wound_rotor is not None
    return motor.wound_rotor


def _pulsations(subject: Subject, random: np.random.Generator) -> tuple[Pulsation, ...]:
    if not subject.swing:
        return ()
    return (Pulsation(subject.swing, frequency_Hz=random.uniform(0.5, 12.0)),)


def _wrong(motor: Motor, random: np.random.Generator) -> Motor:
    """The motor with parameters anywhere within their tolerances."""
    factors = {
        name: getattr(motor.parameters, name)
        * (1.0 + random.uniform(-1.0, 1.0) * getattr(motor.tolerances, name))
        for name in ParameterTolerances.names()
    }
    return replace(motor, parameters=replace(motor.parameters, **factors))
