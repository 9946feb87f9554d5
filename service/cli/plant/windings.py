"""What commands say and take of stator windings: those that are given, and what is typical of the others."""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass

from core.commissioning.errors import CommissioningError
from core.machines.motor_file.reader import Plate
from core.machines.parameters import Motor
from core.machines.stator_winding import (
    StatorWinding,
    WindingError,
    WindingKind,
    check_winding,
    winding_words,
)
from core.machines.typical_winding import typical_winding
from service.plant import PlantMotor

OPTIONS = {
    "kind": "--winding",
    "slots": "--slots",
    "layers": "--layers",
    "coil_pitch_slots": "--coil-pitch",
}
LAYERS = 2

MOST_NAMED = 5
WHAT_IT_BRINGS = (
    "shorted turns are searched on all axes that coils may have; with [motor.winding] from a winder's sheet "
    "the phase and the level of shorted turns are surer (docs/how-to/stator-winding.md)"
)


def proposals(motors: Iterable[PlantMotor]) -> Iterator[str]:
    """Yield a sentence for each winding that is typical of motors whose own is not given."""
    alike: dict[str, list[str]] = {}
    for one in motors:
        if one.motor.winding is None:
            alike.setdefault(str(typical_winding(one.motor.nameplate)), []).append(one.name)
    for typical, names in alike.items():
        more = len(names) - MOST_NAMED
        named = ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
        yield f"stator winding not given: {named}: {WHAT_IT_BRINGS}; typical of the rating: {typical}"


def winding_document(one: PlantMotor) -> dict[str, object]:
    """Return a motor's winding as its file gives it, and what is typical of the rating where it does not."""
    winding = one.motor.winding
    return {
        "motor": one.name,
        "winding": None if winding is None else asdict(winding),
        "typical": None if winding is not None else asdict(typical_winding(one.motor.nameplate)),
    }


@dataclass(frozen=True, slots=True)
class WinderSheet:
    """What the command line says of a stator winding; None where it says nothing."""

    kind: WindingKind | None = None
    slots: int | None = None
    layers: int | None = None
    coil_pitch_slots: int | None = None

    @property
    def is_empty(self) -> bool:
        """Whether it says nothing."""
        return self == WinderSheet()


def winding_of_sheet(sheet: WinderSheet, plate: Plate) -> StatorWinding | None:
    """Return a motor's winding: as its file has it, with what the sheet says in its place.

    Raises CommissioningError where that is no winding of such a motor.
    """
    before = plate.winding
    if sheet.is_empty:
        return before
    kind = sheet.kind if sheet.kind is not None or before is None else before.kind
    slots = sheet.slots if sheet.slots is not None or before is None else before.slots
    if kind is None or slots is None:
        missing = OPTIONS["kind"] if kind is None else OPTIONS["slots"]
        raise CommissioningError(
            "winder's sheet", "stator winding", expected="--winding and --slots", found=f"no {missing}"
        )
    layers, pitch = sheet.layers, sheet.coil_pitch_slots
    if layers is None:
        layers = LAYERS if before is None else before.layers
    if pitch is None and before is not None and before.slots == slots:
        pitch = before.coil_pitch_slots
    winding = StatorWinding(kind, slots, layers, pitch)
    try:
        check_winding(winding, plate.nameplate.pole_pairs)
    except WindingError as error:
        raise CommissioningError(
            "winder's sheet", OPTIONS[error.figure], expected=error.expected, found=str(error.found)
        ) from error
    return winding


def winding_row(motor: Motor) -> tuple[str, str]:
    """Return a motor's winding in words, and a remark: what is typical where it is not given."""
    if motor.winding is not None:
        return winding_words(motor.winding), ""
    return "not given", f"typical of the rating: {typical_winding(motor.nameplate)}"


def winding_lines(motor: Motor) -> str:
    """Return a motor's winding in a line, and what is typical in another one where it is not given."""
    winding, remark = winding_row(motor)
    return "\n".join(filter(None, (f"stator winding: {winding}", remark)))
