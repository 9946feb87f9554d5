"""Commissioning of a wound rotor from a start by steps of resistance: its inertia, with the load.

What a cage's start tells of the impedances, the first cycles of standstill on full voltage, such a start does
not have. They are the motor file's, and so is the resistance with shorted rings.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from time import perf_counter

import numpy as np

from core.commissioning.result import Commissioning, Estimate, StartFound
from core.commissioning.start import Start
from core.commissioning.stepped_start import LEFT_OUT_CYCLES, SteppedStart, half_intervals, stepped_start
from core.machines.air_gap import positive_sequence
from core.machines.base import Array
from core.machines.motor_file.reader import Plate
from core.machines.parameters import MachineParameters, Motor, ParametersSource
from core.machines.wound_rotor import turns_ratio

FIXED = "the motor file's value: a start by steps of resistance does not tell it"
TYPICAL = "typical of the rating: a start by steps of resistance does not tell it"


def commission_stepped(starts: Sequence[Start], plate: Plate, begun: float) -> Commissioning | None:
    """Estimate inertia and load from starts by steps of resistance.

    Parameters
    ----------
    starts : sequence of Start
        The starts.
    plate : Plate
        What is known of the motor.
    begun : float
        Time of `time.perf_counter` from which the computing time counts [s].

    Returns
    -------
    Commissioning or None
        What was found; None where a start has no steps.
    """
    motor = plate.motor
    found = [stepped_start(one.air_gap(motor.parameters), motor) for one in starts]
    stepped = [one for one in found if one is not None]
    if len(stepped) < len(starts):
        return None
    halves = [half_intervals(start, motor, one) for start, one in zip(starts, stepped, strict=True)]
    inertias = np.array([one.inertia_kgm2 for one in stepped])
    inertia = float(inertias.mean())
    half = float(np.hypot(max(one[0] for one in halves), np.ptp(inertias) / 2.0))
    source = TYPICAL if plate.parameters is None else FIXED
    estimates = {
        name: Estimate(getattr(motor.parameters, name), None, source)
        for name in MachineParameters.__dataclass_fields__
    }
    estimates["inertia_kgm2"] = Estimate(inertia, (inertia - half, inertia + half))
    return Commissioning(
        motor=_with_inertia(plate, inertia),
        parameters=estimates,
        change={},
        starts=tuple(
            _start_found(start, one, motor, float(half[1]))
            for start, one, half in zip(starts, stepped, halves, strict=True)
        ),
        load_law=stepped[0].load_law.name.lower(),
        condition_number=float("inf"),
        reasons=tuple(
            f"{start.source}: {_in_words(one, motor, half)}"
            for start, one, half in zip(starts, stepped, halves, strict=True)
        ),
        warnings=(),
        evaluations=len(starts),
        compute_seconds=perf_counter() - begun,
    )


def _with_inertia(plate: Plate, inertia_kgm2: float) -> Motor:
    motor = plate.motor
    return replace(
        motor,
        parameters=replace(motor.parameters, inertia_kgm2=inertia_kgm2),
        parameters_source=motor.parameters_source
        if plate.parameters is None
        else ParametersSource.COMMISSIONED,
    )


def _start_found(start: Start, found: SteppedStart, motor: Motor, half_Nm: float) -> StartFound:
    rated = motor.nameplate.rated_torque_Nm
    load, reach = found.load_torque_Nm / rated, half_Nm / rated
    left_A, share = _left(start, found, motor)
    return StartFound(
        record=start.source,
        onset_s=start.onset_s,
        compared_s=start.compared_s,
        load_level=Estimate(load, (load - reach, load + reach)),
        time_offset_s=Estimate(0.0, None, "taken to be none"),
        residual_rms_A=left_A * start.line_per_winding_current,
        residual_share=share,
    )


def _left(start: Start, found: SteppedStart, motor: Motor) -> tuple[float, float]:
    """Return the fundamental current that the T circuit leaves away from the steps [A], and its share."""
    machine = motor.parameters
    gap = start.air_gap(machine)
    w, n, out = 2.0 * pi * gap.frequency_hz, found.speed.size, round(LEFT_OUT_CYCLES * gap.cycle)
    turn = np.exp(-1j * w / gap.sample_rate_hz * np.arange(n))
    i, v = (positive_sequence((x[0] + 1j * x[1]) * turn, gap.cycle) for x in (gap.current_ab, gap.voltage_ab))
    begins = np.round(np.array(found.begins_s) * gap.sample_rate_hz)
    step = np.searchsorted(begins, np.arange(n), side="right") - 1
    lam = (w - found.speed) / found.rotor_circuit_ohm[step]
    rotor = lam / (w * (1.0 + 1j * lam * machine.rotor_leakage_H))
    air_gap = 1.0 / (rotor + 1.0 / (1j * w * machine.magnetising_inductance_H))
    modelled = v / (machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H + air_gap)
    settled = np.abs(np.arange(n)[:, np.newaxis] - np.append(begins, n)).min(axis=1) > out
    left, whole = np.abs(i - modelled)[settled], np.abs(i)[settled]
    rms_A = float(np.sqrt(np.mean(left**2)))
    return rms_A, rms_A / float(np.sqrt(np.mean(whole**2)))


def _in_words(found: SteppedStart, motor: Motor, half: Array) -> str:
    """Return the resistances of the steps at the slip rings."""
    square, R_r = turns_ratio(motor) ** 2, motor.parameters.rotor_resistance_ohm
    steps = [
        f"{begin_s:.2f} s: {max(0.0, ohm - R_r) / square:.3g} ohm (within {reach / square:.2g})"
        for begin_s, ohm, reach in zip(
            found.begins_s, found.rotor_circuit_ohm.tolist(), half[2:].tolist(), strict=True
        )
    ]
    return f"resistance at the slip rings after switching on, a phase: {', '.join(steps)}"
