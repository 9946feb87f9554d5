"""The stator winding as its maker wound it: where its coils lie, and how well each is linked with its phase.

A phase of a distributed winding has several coils a pole. Each lies on an axis of its own, some electrical
degrees beside that of the phase, and links the field better than the phase's turns do on the average:

    q = slots / (6 p) = n / d in lowest terms,   step = 60 deg / n
    axis_i = (i - (n - 1) / 2) step, i = 0 .. n-1,   k_d = sin(n step / 2) / (n sin(step / 2))

The star of slots gives it for whole q (n = q) and for fractions. The coils of a concentric group share the
axis of their phase. In one layer, a coil joins a slot of the phase with one on the next pole. Where it spans
d slots less than a pole (chain windings), half of the coils go to the right, half to the left, and the axes
lie closer together: those of 24 slots and 4 poles with coils of 1 to 6 are all on the phase's.

Pyrhonen, Jokinen, Hrabovcova, Design of Rotating Electrical Machines, 2nd ed., 2.2 to 2.11.
"""

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from math import cos, gcd, pi, sin
from typing import Final, Literal

Winding = Literal[0, 1, 2]
"""A phase's winding, in the frame of the machine models."""

PHASES: Final = 3
SECTOR_RAD: Final = pi / 3.0
"""Sector of the star of slots that belongs to one side of a phase's coils."""


class WindingKind(StrEnum):
    """How the coils of a group are laid."""

    LAP = "lap"
    CONCENTRIC = "concentric"


class WindingError(ValueError):
    """A winding that cannot be wound.

    Parameters
    ----------
    figure : str
        Field of `StatorWinding` at fault.
    found : int
        Its value.
    expected : str
        What was expected, in words.
    """

    def __init__(self, figure: str, found: int, expected: str) -> None:
        self.figure, self.found, self.expected = figure, found, expected
        super().__init__(f"{figure} is {found}: expected {expected}")


@dataclass(frozen=True, slots=True)
class CoilAxis:
    """Where coils of a phase lie.

    Parameters
    ----------
    angle_rad : float
        Electrical angle from the phase's axis, positive in the direction in which the field turns while the
        supply's sequence is a-b-c [rad].
    linkage : float
        Flux of the fundamental field that a turn of these coils links, over that of the phase's mean turn.
    """

    angle_rad: float
    linkage: float


@dataclass(frozen=True, slots=True)
class StatorWinding:
    """Data of a stator winding, as a winder's sheet or a catalogue gives them.

    Parameters
    ----------
    kind : WindingKind
        How the coils are laid.
    slots : int
        Slots of the stator.
    layers : {1, 2}, default 2
        Coil sides in a slot.
    coil_pitch_slots : int or None, optional
        Slots from one side of a coil to the other; None where it is not known.
    """

    kind: WindingKind
    slots: int
    layers: int = 2
    coil_pitch_slots: int | None = None

    @property
    def coils_per_phase(self) -> int:
        """Coils of a phase, in all its groups and branches."""
        return self.slots * self.layers // (2 * PHASES)

    def is_full_pitch(self, pole_pairs: int) -> bool:
        """Return whether a coil spans a whole pole.

        Parameters
        ----------
        pole_pairs : int
            Pole pairs of the motor.

        Returns
        -------
        bool
            Whether it does; False where the pitch is not known.
        """
        return self.coil_pitch_slots is not None and self.coil_pitch_slots * 2 * pole_pairs == self.slots

    def coil_axes(self, pole_pairs: int) -> tuple[CoilAxis, ...]:
        """Return where the coils of a phase lie, each axis having as many coils as the others.

        Of coils of one layer whose pitch is not known, the axes of full pitch and of a chain are returned.

        Parameters
        ----------
        pole_pairs : int
            Pole pairs of the motor.

        Returns
        -------
        tuple of CoilAxis
            The axes, in the order of their angles.

        Raises
        ------
        WindingError
            If a motor with so many poles cannot have this winding.
        """
        check_winding(self, pole_pairs)
        if self.kind is WindingKind.CONCENTRIC:
            return (CoilAxis(0.0, 1.0),)
        coils = Fraction(self.slots, 2 * PHASES * pole_pairs)
        of_full_pitch = axes_of_coils_per_group(coils.numerator)
        if self.layers == 2 or coils.denominator > 1:
            return of_full_pitch
        if self.coil_pitch_slots is None:
            chain = axes_of_chain(coils.numerator, coils.numerator // 2)
            return tuple(sorted((*of_full_pitch, *chain), key=lambda one: one.angle_rad))
        return axes_of_chain(coils.numerator, abs(PHASES * coils.numerator - self.coil_pitch_slots))


def winding_words(winding: StatorWinding) -> str:
    """Return a winding in words.

    Parameters
    ----------
    winding : StatorWinding
        The winding.

    Returns
    -------
    str
        Such as "lap, 36 slots, two layers, coil pitch 8 slots".
    """
    layers = "one layer" if winding.layers == 1 else "two layers"
    words = [winding.kind.value, f"{winding.slots} slots", layers]
    if winding.coil_pitch_slots is not None:
        words.append(f"coil pitch {winding.coil_pitch_slots} slots")
    return ", ".join(words)


def axes_of_coils_per_group(coils: int) -> tuple[CoilAxis, ...]:
    """Return where the coils of a lap winding lie whose groups show so many different coils.

    Parameters
    ----------
    coils : int
        Slots per pole and phase q; of a fraction its numerator.

    Returns
    -------
    tuple of CoilAxis
        The axes, in the order of their angles.
    """
    step = SECTOR_RAD / coils
    distribution = sin(coils * step / 2.0) / (coils * sin(step / 2.0))
    middle = (coils - 1) / 2.0
    return tuple(CoilAxis((i - middle) * step, 1.0 / distribution) for i in range(coils))


def axes_of_chain(coils: int, shortened: int) -> tuple[CoilAxis, ...]:
    """Return where the coils of a winding of one layer lie that span less than a pole.

    Parameters
    ----------
    coils : int
        Slots per pole and phase q, whole.
    shortened : int
        Slots by which a coil spans less than a pole. Of three coils two are so, and the third one slot more.

    Returns
    -------
    tuple of CoilAxis
        The axes, in the order of their angles. Where no coils of one layer can lie so, those of full pitch.
    """
    if shortened > 0 and coils % (2 * shortened) == 0:
        # Slots of the phase from which a coil goes to the right, counted from 0, and how short it is.
        starts = [(i, shortened) for i in range(coils) if i // shortened % 2 == 1]
    elif coils == PHASES and 0 < shortened < PHASES:
        starts = [(1, 1), (2, 2), (2, 1)]
    else:
        return axes_of_coils_per_group(coils)
    step = SECTOR_RAD / coils
    distribution = sin(coils * step / 2.0) / (coils * sin(step / 2.0))
    return tuple(
        CoilAxis((i - short / 2.0 - (coils - 1) / 2.0) * step, cos(short * step / 2.0) / distribution)
        for i, short in starts
    )


def check_winding(winding: StatorWinding, pole_pairs: int) -> None:
    """Check that a motor can have a winding.

    Parameters
    ----------
    winding : StatorWinding
        The winding.
    pole_pairs : int
        Pole pairs of the motor.

    Raises
    ------
    WindingError
        If it cannot; the message says which figure is wrong and what was expected.
    """
    slots, poles = winding.slots, 2 * pole_pairs
    if winding.layers not in (1, 2):
        raise WindingError("layers", winding.layers, "1 or 2 coil sides in a slot")
    if slots < PHASES * poles or slots % PHASES != 0:
        expected = f"a multiple of 3, at least {PHASES * poles} for {poles} poles"
        raise WindingError("slots", slots, expected)
    if slots % (2 * PHASES) != 0 and winding.layers == 1:
        raise WindingError("slots", slots, "a multiple of 6 in a winding of one layer, or layers = 2")
    if (slots // gcd(slots, pole_pairs)) % PHASES != 0:
        expected = (
            f"slots in which three phases of {poles} poles are alike, such as {PHASES * poles} or "
            f"{2 * PHASES * poles}; is pole_pairs right?"
        )
        raise WindingError("slots", slots, expected)
    pitch, most = winding.coil_pitch_slots, slots // pole_pairs
    if pitch is not None and not 1 <= pitch <= most:
        expected = f"1 to {most} slots from side to side of a coil; a pole has {slots / poles:g}"
        raise WindingError("coil_pitch_slots", pitch, expected)
