"""Plausibility: whether the estimated parameters can belong to the motor on the nameplate.

The quality of the fit does not show a wrong current ratio: k times the current fits a motor with 1/k of every
impedance, k times the inertia and k times the load. Only a comparison with the nameplate and with typical
motors shows it. Impossible motors are refused, and unusual ones cause a warning.
"""

from collections.abc import Sequence
from math import exp, inf, log

from core.commissioning.errors import CommissioningError
from core.commissioning.prior import PARAMETERS, Prior
from core.commissioning.result import Estimate, StartFound
from core.commissioning.start import Start
from core.commissioning.unknowns import HIGHEST_LOAD, LOWEST_LOAD
from core.machines.parameters import Motor
from core.quality import circle_diagram
from core.quantity_text import plain, with_unit

USUAL_PULL_OUT, POSSIBLE_PULL_OUT = (2.0, 5.0), (0.8, 10.0)
"""Pull-out over rated torque. IEC 60034-1 asks for 1.6 at least; catalogues of cage motors have 2 to 4."""
USUAL_LOCKED, POSSIBLE_LOCKED = (5.0, 13.0), (2.0, 30.0)
"""Apparent power of the locked rotor over rated power [VA/W]. IEC 60034-12 allows 10 to 13 (design N, from
0.4 kW on)."""
HIGHEST_USUAL_LOAD = 1.3
AT_A_BOUND = 0.02
"""Distance to the end of the allowed range at which a load level counts as stopped by it."""
OTHER_RATIO, ALIKE = 1.4, 1.25
"""Limits for a wrong ratio of a transformer.

The recording contradicts the motor file beyond the first factor. The cause is one wrong ratio if the factors
of all impedances agree within the second.
"""
OTHER_INERTIA = 2.0
DELTA_FOR_STAR = 3.0
UNUSUAL_DELAY_CYCLES = 0.1
"""A longer delay T_d is unusual, because a relay samples its channels together."""
NEAR_CYCLES = 0.08
"""Tolerance around half a cycle and a third of a cycle.

Such delays point to reversed currents and to cyclically exchanged phases.
"""

IMPEDANCES, INERTIA = PARAMETERS[:4], PARAMETERS[4]
CHECK = (
    "check the current transformers' ratio and the units of the recording, rated_power_W and "
    "rated_voltage_V, and whether the recording is this motor's"
)

Range = tuple[float, float]


def contradictions(
    motor: Motor, estimates: dict[str, Estimate], starts: Sequence[StartFound], prior: Prior
) -> list[str]:
    """Say what is unusual about the motor found, with what to check.

    Parameters
    ----------
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    estimates : dict of str to Estimate
        Parameters by name.
    starts : sequence of StartFound
        What was found of each start.
    prior : Prior
        What is expected of the motor before a record is seen.

    Returns
    -------
    list of str
        Sentences.

    Raises
    ------
    CommissioningError
        If no motor of this nameplate can be so.
    """
    identified = [name for name in PARAMETERS if estimates[name].fixed is None]
    if not identified:
        return []
    return [
        *_loads(starts),
        *_torque_and_inrush(motor, starts),
        *_compared_with_motor_file(estimates, identified, prior),
    ]


def delay_warning(start: Start, time_offset_s: float) -> str | None:
    """Say what a delay that no relay's channels have may be in truth.

    Parameters
    ----------
    start : Start
        The start.
    time_offset_s : float
        The delay found [s].

    Returns
    -------
    str or None
        A sentence; None where the delay is an ordinary one.
    """
    cycles = time_offset_s / start.cycle_s
    if abs(cycles) <= UNUSUAL_DELAY_CYCLES:
        return None
    said = f"{start.source}: time offset: the currents are {1e3 * time_offset_s:.2f} ms late"
    if start.offset_hint_s is None and abs(abs(cycles) - 1.0 / 2.0) < NEAR_CYCLES:
        return (
            f"{said}, half a cycle: all currents (or all voltages) are most likely reversed; the parameters "
            "are not touched by it, a diagnosis is: exchange the wires of the transformers"
        )
    if start.offset_hint_s is None and abs(abs(cycles) - 1.0 / 3.0) < NEAR_CYCLES:
        return (
            f"{said}, a third of a cycle: the phases are most likely exchanged in a ring; the parameters "
            "are not touched by it, a diagnosis is: check which channel is which phase"
        )
    return (
        f"{said}: a relay samples its channels together, so check whether currents and voltages were "
        "recorded by one device and are of the same feeder"
    )


def _loads(starts: Sequence[StartFound]) -> list[str]:
    warnings = []
    for start in starts:
        load = start.load_level
        if load.fixed is not None:
            continue
        if min(load.value - LOWEST_LOAD, HIGHEST_LOAD - load.value) < AT_A_BOUND:
            raise CommissioningError(
                start.record,
                "load level",
                expected=f"a load between {LOWEST_LOAD:g} and {HIGHEST_LOAD:g} times the rated torque",
                found=f"{load.value:.2f}, the end of what is searched: currents or voltages are scaled "
                f"wrongly, or the nameplate is another motor's; {CHECK}",
            )
        if load.value > HIGHEST_USUAL_LOAD:
            warnings.append(
                f"{start.record}: load level: {load.value:.2f} times the rated torque is more than a motor "
                f"is run at; {CHECK}"
            )
    return warnings


def _torque_and_inrush(motor: Motor, starts: Sequence[StartFound]) -> list[str]:
    plate = motor.nameplate
    circle = circle_diagram(motor, plate.rated_frequency_Hz)
    pull_out = circle.pull_out_torque_Nm / plate.rated_torque_Nm
    locked = plate.rated_voltage_V**2 * circle.at_standstill / plate.rated_power_W
    power = with_unit(plate.rated_power_W, "W", 6)
    said = (
        f"{plain(pull_out, 2)} times the rated torque at pull-out and {with_unit(locked, 'VA', 2)} per rated "
        "watt with the rotor locked"
    )
    if not (_within(pull_out, POSSIBLE_PULL_OUT) and _within(locked, POSSIBLE_LOCKED)):
        raise CommissioningError(
            ", ".join(start.record for start in starts),
            "nameplate",
            expected=f"a motor of {power}: {_text(USUAL_PULL_OUT)} times the rated torque at pull-out, "
            f" {_text(USUAL_LOCKED)} VA per rated watt with the rotor locked",
            found=f"{said}: {CHECK}",
        )
    if _within(pull_out, USUAL_PULL_OUT) and _within(locked, USUAL_LOCKED):
        return []
    return [
        f"nameplate: {said} is unusual for a motor of {power} ({_text(USUAL_PULL_OUT)} "
        f"and {_text(USUAL_LOCKED)}); {CHECK}"
    ]


def _compared_with_motor_file(
    estimates: dict[str, Estimate], identified: Sequence[str], prior: Prior
) -> list[str]:
    """Compare the estimates with the motor file; a common factor points to a wrong transformer ratio."""
    if not prior.from_file:
        return []
    off = {name: log(estimates[name].value / getattr(prior.expected, name)) for name in identified}
    impedances = [off[name] for name in IMPEDANCES if name in off]
    inertia = off.get(INERTIA, 0.0)
    limit = log(OTHER_RATIO)
    if len(impedances) > 1 and max(impedances) - min(impedances) < log(ALIKE):
        common = sum(impedances) / len(impedances)
        if abs(common) > limit:
            return [_ratio(common, inertia, known=INERTIA in off)]
    far = [
        f"{name} ({plain(exp(one), 2)} times)"
        for name, one in off.items()
        if abs(one) > log(prior.spread[name])
    ]
    if far:
        return [f"motor file: the recording contradicts its {', '.join(far)}: is it this motor's? {CHECK}"]
    if abs(inertia) > log(OTHER_INERTIA) and max(map(abs, impedances), default=inf) < log(ALIKE):
        return [
            f"motor file: the inertia is {plain(exp(inertia), 2)} times the file's, all else alike: the "
            "load's inertia counts, and pole_pairs squared does; check both"
        ]
    return []


def _ratio(common: float, inertia: float, *, known: bool) -> str:
    said = f"motor file: all impedances are {plain(exp(common))} times the file's"
    near = log(ALIKE)
    if known and abs(inertia + common) < near:
        return (
            f"{said} and the inertia {plain(exp(inertia))} times: the recorded currents are "
            f"{plain(exp(-common))} times the true ones; check the current transformers' ratio and the "
            "units of the recording"
        )
    if known and abs(inertia - common) < near:
        return (
            f"{said}, and the inertia too: the recorded voltages are {plain(exp(common))} times the true "
            "ones; check the voltage transformers' ratio"
        )
    if abs(abs(common) - log(DELTA_FOR_STAR)) < near:
        return f"{said}, as if star were delta: check connection in [nameplate]"
    return f"{said}; {CHECK}"


def _within(value: float, limits: Range) -> bool:
    return limits[0] <= value <= limits[1]


def _text(limits: Range) -> str:
    return f"{limits[0]:g} to {limits[1]:g}"
