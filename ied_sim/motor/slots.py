"""A stator winding by its slots: which coil lies where, of which phase, group and branch.

Slots are numbered around the bore, and q = slots / (6 pole pairs) of them make a phase belt. A winding in two
layers has a group of q coils at every pole, one in one layer at every second pole. The coils of a lap winding
are alike and lie q apart beside each other; those of a concentric winding lie in the same slots, one inside
the other. A coil's place is the angle of its axis. Axes of phases a, b and c are 0, 120 and 240 electrical
degrees in the direction in which slots are counted.

Reference: J. Pyrhonen, T. Jokinen, V. Hrabovcova, Design of Rotating Electrical Machines, ch. 2.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import Literal

Kind = Literal["lap", "concentric"]


@dataclass(frozen=True, slots=True)
class Coil:
    """A coil: its phase and branch, the slots of its two sides, and how its current counts.

    Parameters
    ----------
    phase : int
        0, 1 or 2 (a, b, c).
    branch : int
        Number of the parallel branch, from 0 on.
    go, back : int
        Slots of its sides. The second may lie beyond the last slot: around the bore it is that modulo slots.
    sign : int
        1, or -1 where it is connected backwards, as under every second pole.
    """

    phase: int
    branch: int
    go: int
    back: int
    sign: int

    @property
    def pitch_slots(self) -> int:
        """Slots that it spans."""
        return self.back - self.go


@dataclass(frozen=True, slots=True)
class SlotWinding:
    """A three-phase winding in slots.

    Parameters
    ----------
    kind : {"lap", "concentric"}
        How the sides of a group are joined to coils.
    slots : int
        Slots of the stator.
    layers : int, default 2
        Coil sides in a slot, 1 or 2.
    coil_pitch_slots : int, optional
        Slots that a coil spans; for a concentric group their mean. The pole pitch with None.
    branches : int, default 1
        Parallel branches of a phase: neighbouring groups in series make one.
    """

    kind: Kind
    slots: int
    layers: int = 2
    coil_pitch_slots: int | None = None
    branches: int = 1

    def coils_per_phase(self) -> int:
        """Return the number N of coils of a phase."""
        return self.slots * self.layers // 6

    def coils_per_group(self, pole_pairs: int) -> int:
        """Return q, the number of coils of a group.

        Raises
        ------
        ValueError
            If there is no such winding for so many pole pairs.
        """
        if self.slots % (6 * pole_pairs):
            raise ValueError(
                f"{self.slots} slots are no multiple of {6 * pole_pairs}, three phases under "
                f"{2 * pole_pairs} poles"
            )
        groups = pole_pairs * self.layers
        if groups % self.branches:
            raise ValueError(f"{groups} groups of a phase make no {self.branches} equal branches")
        pitch, pole = self.coil_pitch_slots, self.slots // (2 * pole_pairs)
        if pitch is not None and (pitch != pole if self.layers == 1 else not pole / 2 < pitch <= pole):
            allowed = f"{pole}" if self.layers == 1 else f"above {pole / 2:g} and at most {pole}"
            raise ValueError(f"a pitch of {pitch} slots is none of this winding: {allowed}")
        q = self.slots // (6 * pole_pairs)
        if self.kind == "concentric" and (pitch or pole) <= q - 1:
            raise ValueError(f"a pitch of {pitch} slots leaves nothing to the innermost coil")
        return q

    def coils(self, pole_pairs: int) -> tuple[Coil, ...]:
        """Return all coils, phase by phase and in each group by group.

        Raises
        ------
        ValueError
            If there is no such winding for so many pole pairs.
        """
        return tuple(self._coils(pole_pairs, self.coils_per_group(pole_pairs)))

    def axis_rad(self, pole_pairs: int, coil: int) -> float:
        """Return the electrical angle of the axis of coil 1 to N from its phase's axis [rad].

        It is positive in the direction from the axis of phase a to that of b.

        Raises
        ------
        ValueError
            If there is no such winding for so many pole pairs.
        """
        q = self.coils_per_group(pole_pairs)
        if self.kind == "concentric":
            return 0.0
        return ((coil - 1) % q - (q - 1) / 2) * 2 * pi * pole_pairs / self.slots

    def _coils(self, pole_pairs: int, q: int) -> Iterator[Coil]:
        pole = self.slots // (2 * pole_pairs)
        pitch = pole if self.coil_pitch_slots is None else self.coil_pitch_slots
        groups = pole_pairs * self.layers
        for phase in range(3):
            for group in range(groups):
                # Two layers: the next group is one pole on and reversed. One layer: two poles on.
                first = 2 * q * phase + group * (pole if self.layers == 2 else 2 * pole)
                sign = -1 if self.layers == 2 and group % 2 else 1
                for place in range(q):
                    other = place if self.kind == "lap" else q - 1 - place
                    branch = group * self.branches // groups
                    yield Coil(phase, branch, first + place, first + other + pitch, sign)
