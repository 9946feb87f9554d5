"""The stator winding typical of a rating, as a proposal where a motor's own is not known. It is no fact.

What is settled:

- Form-wound coils, of rectangular wire that is shaped before it is laid, are lap coils of two layers. Motors
  above about 1 kV have them. IEC 60034-18-41 speaks of machines below 700 V, whose stators tend to be
  random-wound, IEC 60034-18-42 of form-wound ones, mostly above (quoted by Ward Leonard Electric, Technical
  Note 12-01, Random-wound vs. Form-wound Stator Coils, 2012).
- Small three-phase motors have one layer, of concentric or chained coils; larger ones two layers, lap.

What is not:

- Where one layer ends is a maker's choice, about 10 to 20 kW. Both are possible there.
- At low voltage coils of either kind are made, from some 100 kW to 1.5 MW (KATO Engineering, Form Wound vs
  Random Wound Alternator Coils). Both are lap coils of two layers then.
- Makers who wind by machine have concentric coils in larger motors too. A repair shop may put a lap winding
  in place of a concentric one, or the reverse (EASA, AC Motor Redesign, sections 10 and 11).
- The numbers of slots are those that are usual, of no single source.

So nothing is computed from a typical winding: `Motor.winding` is what a file says.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.machines.parameters import Nameplate
from core.machines.stator_winding import WindingKind

FORM_WOUND_V: Final = 1000.0
ONE_LAYER_W: Final = 10e3
TWO_LAYERS_W: Final = 20e3
"""Up to the one, motors usually have one layer; from the other on, two."""

SMALL_MOTORS_SLOTS: Final = {1: (24, 36), 2: (24, 36), 3: (36, 54), 4: (36, 48)}
LARGE_MOTORS_SLOTS: Final = {1: (36, 48), 2: (36, 48, 60, 72), 3: (54, 72), 4: (72, 96)}
"""Usual numbers of slots by pole pairs, for motors of one and of two layers."""


@dataclass(frozen=True, slots=True)
class TypicalWinding:
    """What windings of a rating usually are.

    Parameters
    ----------
    kinds : tuple of WindingKind
        How the coils are laid, the likelier first.
    layers : tuple of int
        Coil sides in a slot, the likelier first.
    slots : tuple of int
        Usual numbers of slots; empty where they are not known.
    """

    kinds: tuple[WindingKind, ...]
    layers: tuple[int, ...]
    slots: tuple[int, ...]

    def __str__(self) -> str:
        """Return it in words, such as "lap, two layers, 36, 48, 60 or 72 slots"."""
        words = [_either(self.kinds), _either([LAYERS[one] for one in self.layers])]
        return ", ".join([*words, f"{_either(self.slots)} slots" if self.slots else "slots not known"])


LAYERS: Final = {1: "one layer", 2: "two layers"}


def typical_winding(nameplate: Nameplate) -> TypicalWinding:
    """Return the winding that is typical of a nameplate.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    TypicalWinding
        What such motors usually have; several where no more is known.
    """
    pairs, power_W = nameplate.pole_pairs, nameplate.rated_power_W
    small, large = SMALL_MOTORS_SLOTS.get(pairs, ()), LARGE_MOTORS_SLOTS.get(pairs, ())
    if nameplate.rated_voltage_V > FORM_WOUND_V or power_W >= TWO_LAYERS_W:
        return TypicalWinding((WindingKind.LAP,), (2,), large)
    kinds = (WindingKind.CONCENTRIC, WindingKind.LAP)
    if power_W <= ONE_LAYER_W:
        return TypicalWinding(kinds, (1,), small)
    return TypicalWinding(kinds, (1, 2), tuple(sorted({*small, *large})))


def _either(choices: Sequence[object]) -> str:
    *others, last = map(str, choices)
    return f"{', '.join(others)} or {last}" if others else last
