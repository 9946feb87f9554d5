"""What lies behind the relay besides the motor: the diagnosis of records of the simulator's feeders."""

from dataclasses import replace

import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Cable as KnownCable
from core.machines.parameters import Capacitors as KnownBank
from core.machines.parameters import Connection, Motor
from ied_sim.motor.feeder import Cable, Capacitors, Feeder, Heater
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.saturation import MainSaturation
from ied_sim.motor.supply import Harmonic
from testing.machines.disturbed_records import record_of
from testing.machines.slot_fault_records import USUAL, SlotFaultCase, drawn_case, with_other_parameters

RATE_HZ = 4_000.0
LEVEL = 0.05


def case_of(seed: int, level: float | None, connection: Connection = Connection.STAR) -> SlotFaultCase:
    """A case of a 7.5 kW motor."""
    return drawn_case(
        seed, level=level, power_kW=7.5, poles=4, sensors=USUAL, most_path_ratio=1.0, connection=connection
    )


def motor_of(case: SlotFaultCase) -> Motor:
    """The motor as its file knows it, with other parameters."""
    return replace(with_other_parameters(case.motor, case.seed), sensors=USUAL)


def diagnosed(plant: MotorPlant, motor: Motor) -> Diagnosis:
    """The diagnosis of a record of a plant."""
    return diagnose(record_of(plant.window(0.0, 0.5, RATE_HZ), RATE_HZ), motor)


def is_called_right(found: Diagnosis, case: SlotFaultCase) -> bool:
    """Whether a fault is called, in its phase, and its interval holds the truth."""
    assert case.fault is not None
    assert found.mu_f_ci95 is not None
    low, high = found.mu_f_ci95
    right = found.phase == "abc"[case.fault.phase] and low <= case.equivalent_level <= high
    return found.verdict is Verdict.FAULT and right


@pytest.mark.parametrize("connection", list(Connection))
def test_capacitors_of_the_file_are_taken_off_the_currents(connection: Connection) -> None:
    feeder = Feeder(Capacitors(2.0, connection))
    known = KnownBank(2.0, connection)
    for seed in (1, 2):
        sound = case_of(seed, None)
        found = diagnosed(replace(sound.plant(), feeder=feeder), replace(motor_of(sound), capacitors=known))
        assert found.verdict is Verdict.HEALTHY, found.reasons
        assert found.load_level == pytest.approx(sound.load_level, abs=0.15)
        faulty = case_of(seed, LEVEL)
        assert is_called_right(
            diagnosed(replace(faulty.plant(), feeder=feeder), replace(motor_of(faulty), capacitors=known)),
            faulty,
        )


@pytest.mark.parametrize("connection", list(Connection))
def test_a_capacitor_that_is_lost_is_named_and_no_fault(connection: Connection) -> None:
    for seed in (3, 4, 5):
        sound = case_of(seed, None)
        feeder = Feeder(Capacitors(4.0, connection, seed % 3, ((0.0, 1.0),)))
        motor = replace(motor_of(sound), capacitors=KnownBank(4.0, connection))
        found = diagnosed(replace(sound.plant(), feeder=feeder), motor)
        assert found.verdict is Verdict.WATCH
        assert found.hypotheses[0].cause is Cause.BEHIND_RELAY, found.reasons
        assert "capacitor or load behind the relay" in found.reasons[0]
        assert "a capacitor lost" in found.hypotheses[0].figure


@pytest.mark.parametrize("amps", [0.06, 0.12, 0.25])
def test_a_two_phase_load_is_no_fault(amps: float) -> None:
    for seed in range(6, 12):
        sound = case_of(seed, None, Connection.DELTA if seed % 2 else Connection.STAR)
        plate = sound.motor.nameplate
        rated_A = plate.rated_power_W / (3**0.5 * plate.rated_voltage_V * 0.75)
        heater = Heater(amps * rated_A * plate.rated_voltage_V, seed % 3, (seed + 1) % 3)
        found = diagnosed(replace(sound.plant(), feeder=Feeder(heaters=(heater,))), motor_of(sound))
        assert found.verdict is not Verdict.FAULT
        if amps == 0.25:
            assert found.verdict is Verdict.WATCH


def test_the_drop_of_a_cable_of_the_file_is_taken_off_the_voltages() -> None:
    feeder = Feeder(cable=Cable(0.7, 0.2))
    for seed in (12, 13):
        faulty = case_of(seed, LEVEL, Connection.DELTA if seed % 2 else Connection.STAR)
        motor = replace(motor_of(faulty), cable=KnownCable(0.7, 0.2))
        found = diagnosed(replace(faulty.plant(), feeder=feeder), motor)
        assert is_called_right(found, faulty), found.reasons


def test_a_motor_on_the_neutral_is_diagnosed_where_the_file_says_so() -> None:
    for seed in (14, 15):
        sound, faulty = case_of(seed, None), case_of(seed, LEVEL)
        for case in (sound, faulty):
            plant = case.plant()
            supply = replace(plant.supply, harmonics=(*plant.supply.harmonics, Harmonic(3, 0.02)))
            plant = replace(plant, supply=supply, feeder=Feeder(neutral=True))
            found = diagnosed(plant, replace(motor_of(case), neutral=True))
            assert found.verdict is Verdict.HEALTHY if case is sound else is_called_right(found, case)
            refused = diagnosed(plant, motor_of(case))
            assert refused.verdict is Verdict.UNDIAGNOSABLE
            assert "`neutral = true`" in refused.reasons[0]


@pytest.mark.parametrize("loss", [0.08, 0.12, 0.2])
def test_iron_that_saturates_is_no_fault(loss: float) -> None:
    iron = MainSaturation(loss / (1.0 - loss) / (1.1**8 - 1.0))
    for seed, volts in ((16, 1.1), (17, 1.1), (18, 0.9)):
        sound, faulty = (replace(case_of(seed, level), relative_voltage=volts) for level in (None, LEVEL))
        found = diagnosed(replace(sound.plant(), main_saturation=iron), motor_of(sound))
        assert found.verdict is not Verdict.FAULT, found.reasons
        assert is_called_right(
            diagnosed(replace(faulty.plant(), main_saturation=iron), motor_of(faulty)), faulty
        )
