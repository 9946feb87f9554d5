"""The nameplate and the parameters of a motor in words."""

from collections.abc import Sequence

from core.machines.parameters import Motor
from core.machines.stator_winding import winding_words
from service.condition.parameter_sources import SOURCES


def nameplate_facts(motor: Motor) -> Sequence[tuple[str, str]]:
    """Return names with figures and units."""
    plate, machine = motor.nameplate, motor.parameters
    return [
        ("rated power", f"{plate.rated_power_W:.6g} W"),
        ("rated voltage", f"{plate.rated_voltage_V:.6g} V line to line"),
        ("rated frequency", f"{plate.rated_frequency_Hz:g} Hz"),
        ("pole pairs", f"{plate.pole_pairs}"),
        ("connection", plate.connection.value),
        *([] if motor.winding is None else [("stator winding", winding_words(motor.winding))]),
        ("stator resistance", f"{machine.stator_resistance_ohm:.4g} ohm"),
        ("rotor resistance", f"{machine.rotor_resistance_ohm:.4g} ohm"),
        ("stator leakage", f"{1e3 * machine.stator_leakage_H:.4g} mH"),
        ("rotor leakage", f"{1e3 * machine.rotor_leakage_H:.4g} mH"),
        ("stator self-inductance", f"{machine.stator_self_inductance_H:.4g} H"),
        ("inertia", f"{machine.inertia_kgm2:.4g} kg m²"),
        ("parameters", SOURCES[motor.parameters_source]),
        ("limit of the fault level", f"{100 * motor.limits.fault_level:.3g} %"),
    ]
