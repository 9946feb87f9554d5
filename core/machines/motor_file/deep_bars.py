"""What of a motor changes from a start to running, as [deep_bars] and [leakage_saturation] say it."""

from dataclasses import asdict

from core.machines import plausibility
from core.machines.deep_bars import USUAL_SHARPNESS, DeepBars, LeakageSaturation
from core.machines.motor_file.table import MotorTable
from core.machines.parameters import Nameplate
from core.quantity_text import plain


def deep_bars(table: MotorTable) -> DeepBars | None:
    """Read how much a rotor changes from a small slip to a great one.

    Parameters
    ----------
    table : MotorTable
        The table [deep_bars].

    Returns
    -------
    DeepBars or None
        The change; None where the file has none.
    """
    if table.is_empty:
        return None
    return DeepBars(
        table.number(
            "resistance_ratio",
            plausibility.DEEP_BAR_RESISTANCE,
            f"{_range(plausibility.DEEP_BAR_RESISTANCE)}, rotor resistance at a great slip over a small one",
        ),
        table.number(
            "leakage_share",
            plausibility.DEEP_BAR_LEAKAGE,
            f"{_range(plausibility.DEEP_BAR_LEAKAGE)}, rotor leakage at a great slip over a small one",
        ),
    )


def leakage_saturation(table: MotorTable, nameplate: Nameplate) -> LeakageSaturation | None:
    """Read how leakage falls with the current.

    Parameters
    ----------
    table : MotorTable
        The table [leakage_saturation].
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    LeakageSaturation or None
        The saturation; None where the file has none.
    """
    if table.is_empty:
        return None
    rated_A = nameplate.rated_power_W / (3.0 * nameplate.winding_voltage_V)
    least, most = plausibility.KNEE_CURRENT
    return LeakageSaturation(
        table.number(
            "share",
            plausibility.SATURATING_LEAKAGE,
            f"{_range(plausibility.SATURATING_LEAKAGE)}, part of the leakage that is lost at great currents",
        ),
        table.number("knee_current_A", (least * rated_A, most * rated_A), unit="A, rms of a winding"),
        table.number(
            "knee_sharpness",
            plausibility.KNEE_SHARPNESS,
            _range(plausibility.KNEE_SHARPNESS),
            default=USUAL_SHARPNESS,
        ),
    )


def change_lines(bars: DeepBars | None, saturation: LeakageSaturation | None) -> list[str]:
    """Return the lines of a motor's file that say what of it changes.

    Parameters
    ----------
    bars : DeepBars or None
        How the rotor changes.
    saturation : LeakageSaturation or None
        How the leakage does.

    Returns
    -------
    list of str
        The lines, none where nothing changes.
    """
    lines = []
    if bars is not None:
        lines += ["", "[deep_bars]"]
        lines += [
            f"resistance_ratio = {bars.resistance_ratio:.4g}",
            f"leakage_share = {bars.leakage_share:.4g}",
        ]
    if saturation is not None:
        lines += ["", "[leakage_saturation]"]
        lines += [f"{name} = {value:.4g}" for name, value in asdict(saturation).items()]
    return lines


def _range(ends: tuple[float, float]) -> str:
    return f"{plain(ends[0])} to {plain(ends[1])}"
