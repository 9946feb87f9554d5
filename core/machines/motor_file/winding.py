"""How a stator is wound, as the table [winding] of a motor's file says it."""

from core.machines import plausibility
from core.machines.motor_file.table import MotorTable
from core.machines.stator_winding import StatorWinding, WindingError, WindingKind, check_winding

MOST_LAYERS = 2


def stator_winding(table: MotorTable, pole_pairs: int | None) -> StatorWinding | None:
    """Read how a stator is wound.

    Parameters
    ----------
    table : MotorTable
        The table [winding].
    pole_pairs : int or None
        Pole pairs of the motor; None where they are not known, and the figures are not compared with them.

    Returns
    -------
    StatorWinding or None
        The winding; None where the file has none, or one that cannot be wound.
    """
    if table.is_empty:
        return None
    kind = table.word("kind", WindingKind.LAP, required=True)
    slots = table.count("slots", plausibility.MOST_STATOR_SLOTS)
    layers = table.optional_count("layers", MOST_LAYERS)
    pitch = table.optional_count("coil_pitch_slots", plausibility.MOST_STATOR_SLOTS)
    if table.has_errors:
        return None
    winding = StatorWinding(kind, slots, MOST_LAYERS if layers is None else layers, pitch)
    if pole_pairs is not None:
        try:
            check_winding(winding, pole_pairs)
        except WindingError as error:
            table.refuse(error.figure, error.expected, error.found)
            return None
    return winding


def winding_lines(winding: StatorWinding | None) -> list[str]:
    """Return the lines of a motor's file that say how its stator is wound.

    Parameters
    ----------
    winding : StatorWinding or None
        The winding, None where it is not known.

    Returns
    -------
    list of str
        The lines, none for an unknown winding.
    """
    if winding is None:
        return []
    pitch = winding.coil_pitch_slots
    return [
        "",
        "[winding]",
        f'kind = "{winding.kind.value}"',
        f"slots = {winding.slots}",
        f"layers = {winding.layers}",
        *([] if pitch is None else [f"coil_pitch_slots = {pitch}"]),
    ]
