"""What a recording shows of rotor and supply as text for people, the same in commands and on pages."""

from math import sqrt

from core.quantity_text import with_unit
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.swing_findings import (
    EVEN_GAP,
    NOISE_RMS,
    STEADY_LOAD,
    EccentricityFinding,
    PulsationFinding,
)
from core.supply.figures import SupplyFigures

STATES = {
    RotorState.HEALTHY: "healthy",
    RotorState.WATCH: "watch",
    RotorState.FAULT: "fault",
    RotorState.UNSUPPORTED: "not assessed",
}
"""What people read of the state of a rotor."""


def rotor_words(finding: RotorFinding) -> str:
    """Return state and severity: "fault, asymmetry -29.0 dB [-31.0..-27.5]; detection limit -52.0 dB"."""
    words = STATES[finding.state]
    if finding.severity_dB is not None:
        words += f", asymmetry {decibels(finding.severity_dB, finding.severity_dB_ci95)}"
    if finding.detection_limit_dB is not None:
        words += f"; detection limit {finding.detection_limit_dB:.1f} dB"
    return words


def sideband_words(finding: RotorFinding) -> str | None:
    """Return both sidebands as measured, with the slip that tells where they are; None without them."""
    lower_dB, upper_dB, slip = finding.lower_sideband_dB, finding.upper_sideband_dB, finding.slip
    if lower_dB is None or upper_dB is None or slip is None:
        return None
    return (
        f"{lower_dB:.1f} dB below, {upper_dB:.1f} dB above the supply's line, at a slip of {100 * slip:.2f} %"
    )


def gap_words(finding: EccentricityFinding) -> str | None:
    """Return by how much the air gap ripples; None of what a sound motor or noise would show."""
    ripple, deviation, limit = finding.permeance_ripple, finding.standard_deviation, finding.detection_limit
    if ripple is None or deviation is None or limit is None:
        return None
    told_from = max(limit, EVEN_GAP)
    if ripple <= told_from:
        return None
    level = f"{100 * ripple:.2f} % (+-{196 * deviation:.2f} %)"
    return f"permeance ripples by {level} once a turn; {100 * told_from:.2f} % would be told"


def swing_words(eccentricity: EccentricityFinding, pulsation: PulsationFinding) -> list[str]:
    """Return by how much the load's torque swings once a turn, and elsewhere.

    Nothing is said of what a steady load or noise would show. What swings at twice the slip the rotor tells.
    """
    turn, deviation = eccentricity.load_torque, eccentricity.load_torque_deviation
    found = (
        (turn, None if deviation is None else sqrt(2.0) * deviation, eccentricity.rotation_frequency_hz),
        (pulsation.load_torque, pulsation.noise, pulsation.frequency_hz),
    )
    words = []
    for (swing, noise, hertz), where in zip(found, (", once a turn", ""), strict=True):
        if swing is None or noise is None or hertz is None:
            continue
        limit = max(NOISE_RMS * noise, STEADY_LOAD)
        if swing > limit:
            told = f"torque swings by {100 * swing:.2f} % of the rated one at {hertz:.2f} Hz{where}"
            words.append(f"{told}; {100 * limit:.2f} % would be told")
    return words


def supply_words(figures: SupplyFigures) -> list[str]:
    """Return the supply in a few phrases: voltage and frequency, unbalance, distortion."""
    mean_V = sum(figures.line_voltages_V) / len(figures.line_voltages_V)
    iec, nema, thd = (
        f"{100 * share:.2f} %"
        for share in (figures.voltage_unbalance_iec, figures.voltage_unbalance_nema, figures.thd_voltage)
    )
    derating = "do not run (NEMA MG-1)" if figures.derating is None else f"derating {figures.derating:.2f}"
    words = [
        f"{with_unit(mean_V, 'V', 4)} ({figures.voltage_deviation:+.1%}), {figures.frequency_hz:.3f} Hz",
        f"unbalance {iec} (IEC), {nema} (NEMA), {derating}",
        f"distortion of the voltage {thd}, HVF {figures.harmonic_voltage_factor:.4f}",
    ]
    if figures.active_power_W is not None and figures.power_factor is not None:
        words.append(f"{with_unit(figures.active_power_W, 'W', 4)}, power factor {figures.power_factor:.3f}")
    return words


def decibels(value_dB: float, ci95: tuple[float, float] | None = None) -> str:
    """Return a level with its 95 % interval: "-29.0 dB [-31.0..-27.5]"."""
    return f"{value_dB:.1f} dB" + ("" if ci95 is None else f" [{ci95[0]:.1f}..{ci95[1]:.1f}]")
