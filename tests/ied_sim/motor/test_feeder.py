"""What lies behind the relay's transformers beside the motor, against phasors and other circuits."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.parameters import Connection, Motor
from core.signals.phasors import harmonic_phasors
from core.signals.terminals import WINDINGS_TO_LINES
from ied_sim.motor.feeder import Cable, Capacitors, Feeder, Heater, OtherMotor
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.saturation import MainSaturation
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.motors import LARGE, MEDIUM
from tests.ied_sim.motor.plants import plant, short

TURN = np.exp(2j * np.pi / 3)
SEQUENCES = np.array([[1, 1, 1], [1, TURN, TURN**2], [1, TURN**2, TURN]]) / 3
"""Zero, positive and negative sequence of three phasors."""
RATE_HZ = 4_000.0


def phasors(motor: MotorPlant, order: int = 1) -> NDArray[np.complex128]:
    """Sequences of the line currents over the positive sequence of the voltages, shape (3,) [S]."""
    true = motor.operation(0.0, 0.2, RATE_HZ)
    frequency = motor.supply.frequency_Hz
    current = SEQUENCES @ harmonic_phasors(true.currents_A, frequency, RATE_HZ, (order,))[:, 0]
    voltage = SEQUENCES @ harmonic_phasors(true.voltages_V, frequency, RATE_HZ, (1,))[:, 0]
    return np.asarray(current / voltage[1])


def added(feeder: Feeder, motor: Motor = MEDIUM) -> NDArray[np.complex128]:
    """What a feeder adds to the currents of a motor alone."""
    alone = plant(motor)
    return np.asarray(phasors(replace(alone, feeder=feeder)) - phasors(alone))


@pytest.mark.parametrize("connection", list(Connection))
def test_a_bank_draws_its_leading_current(connection: Connection) -> None:
    zero, positive, negative = added(Feeder(Capacitors(3.0, connection)))
    assert positive == pytest.approx(3e3j / 400.0**2, rel=1e-4)
    assert abs(zero) + abs(negative) < 1e-6


def test_a_bank_that_lost_a_branch_lacks_a_load_between_two_lines() -> None:
    bank = Capacitors(3.0, Connection.DELTA, branch=1, lost=((0.0, 1.0),))
    _, positive, negative = added(Feeder(bank))
    whole = 3e3j / 400.0**2
    assert positive == pytest.approx(whole * 2 / 3, rel=1e-4)
    assert negative == pytest.approx(whole / 3, rel=1e-4), "branch bc: -(-Y) of an element across it"


def test_a_star_that_lost_a_branch_is_what_is_left_in_series() -> None:
    bank = Capacitors(3.0, Connection.STAR, branch=0, lost=((0.0, 1.0),))
    _, positive, negative = added(Feeder(bank))
    left = 3e3j / 400.0**2 / 2  # half of one branch between lines b and c
    assert positive == pytest.approx(left, rel=1e-4)
    assert negative == pytest.approx(-left, rel=1e-4)


def test_heaters_of_two_phases_and_of_one() -> None:
    zero, positive, negative = added(Feeder(heaters=(Heater(800.0, 1, 2),)))
    assert positive == pytest.approx(800.0 / 400.0**2, rel=1e-4)
    assert negative == pytest.approx(-positive, rel=1e-4)
    assert abs(zero) < 1e-9
    one = added(Feeder(heaters=(Heater(800.0, 0),)))
    assert one == pytest.approx(np.full(3, 800.0 / 400.0**2), rel=1e-4)
    assert added(Feeder(heaters=(Heater(800.0, 0, since_s=1e6),))) == pytest.approx(np.zeros(3), abs=1e-9)


@pytest.mark.parametrize("motor", [MEDIUM, LARGE])
def test_a_cable_is_more_of_the_stators_own_impedance(motor: Motor) -> None:
    per_winding = 3.0 if motor.nameplate.connection is Connection.DELTA else 1.0
    with_cable = replace(plant(motor), feeder=Feeder(cable=Cable(0.05, 0.08)))
    more = replace(
        motor.parameters,
        stator_resistance_ohm=motor.parameters.stator_resistance_ohm + per_winding * 0.05,
        stator_leakage_H=motor.parameters.stator_leakage_H + per_winding * 0.08 / (100 * np.pi),
    )
    assert phasors(with_cable) == pytest.approx(
        phasors(plant(replace(motor, parameters=more))), rel=1e-3, abs=1e-5
    )


def test_two_motors_draw_twice_the_current() -> None:
    alone = plant(MEDIUM)
    both = replace(alone, feeder=Feeder(other_motor=OtherMotor(MEDIUM, Load(0.5))))
    assert phasors(both)[1] == pytest.approx(2 * phasors(alone)[1], rel=1e-3)
    later = replace(alone, feeder=Feeder(other_motor=OtherMotor(MEDIUM, Load(0.5), since_s=1e6)))
    assert phasors(later)[1] == pytest.approx(phasors(alone)[1], rel=1e-6)


def test_lines_of_a_delta_are_differences_of_its_windings() -> None:
    faulty = plant(LARGE, fault=short(0.03))
    line = faulty.operation(0.0, 0.1, RATE_HZ).currents_A
    windings = replace(faulty, feeder=Feeder(inside_delta=True)).operation(0.0, 0.1, RATE_HZ).currents_A
    assert WINDINGS_TO_LINES @ windings == pytest.approx(line, abs=1e-6)


def test_a_fourth_wire_carries_what_the_star_point_would_not() -> None:
    supply = Supply(400.0, 50.0, harmonics=(Harmonic(3, 0.02),))
    three_wires = plant(MEDIUM, supply=supply)
    four = replace(three_wires, feeder=Feeder(neutral=True))
    assert abs(phasors(three_wires, 3)[0]) < 1e-6
    z = MEDIUM.parameters.stator_resistance_ohm + 3j * 100 * np.pi * MEDIUM.parameters.stator_leakage_H
    assert abs(phasors(four, 3)[0]) == pytest.approx(0.02 / abs(z), rel=0.01)
    assert phasors(four)[1] == pytest.approx(phasors(three_wires)[1], rel=1e-4)


def test_the_main_inductance_follows_the_voltage() -> None:
    iron = MainSaturation(0.12 / 0.88 / (1.1**8 - 1.0))

    def no_load(voltage: float, saturation: MainSaturation) -> complex:
        idle = plant(MEDIUM, level=0.0, supply=Supply(400.0 * voltage, 50.0))
        return complex(phasors(replace(idle, main_saturation=saturation))[1])

    for voltage, inductance in ((1.0, 1.0), (1.1, 0.88)):
        less = replace(
            MEDIUM.parameters,
            stator_self_inductance_H=inductance * MEDIUM.parameters.stator_self_inductance_H,
        )
        linear = plant(replace(MEDIUM, parameters=less), level=0.0, supply=Supply(400.0 * voltage, 50.0))
        assert no_load(voltage, iron) == pytest.approx(complex(phasors(linear)[1]), rel=0.01)
    assert abs(no_load(1.0, MainSaturation())) == pytest.approx(abs(no_load(1.1, MainSaturation())))


def test_the_rated_current_of_a_bank_does_not_depend_on_the_load() -> None:
    bank = Feeder(Capacitors(3.0))
    changes = [
        phasors(replace(plant(MEDIUM, level=level), feeder=bank)) - phasors(plant(MEDIUM, level=level))
        for level in (0.1, 0.9)
    ]
    assert changes[0] == pytest.approx(changes[1], rel=1e-6)
    assert 3e3 / (sqrt(3) * 400.0) == pytest.approx(abs(changes[0][1]) * 400.0 / sqrt(3))
