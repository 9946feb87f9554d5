"""Windings that are measured, and motors that have them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, sin

from core.machines.parameters import Connection, Motor, WoundRotor
from ied_sim.motor.slot_leakage import USUAL_SLOTS, SlotShape
from ied_sim.motor.slots import SlotWinding
from testing.machines.rated_motors import rated_motor

POWERS_KW = (0.8, 7.5, 160.0)
SHARES = (0.01, 0.03, 0.1, 0.3, 0.6, 1.0)
"""Shorted shares of a coil's turns."""
PATHS = (0.0, 0.5, 2.0, 8.0)
LEAST_SHARE_OF_C = 0.1
ROTOR = WoundRotor(open_circuit_voltage_V=240.0, rated_current_A=98.0)
"""What makes a rotor wound; its figures do not matter here."""


@dataclass(frozen=True, slots=True)
class Case:
    """A winding, the poles of its motors, and whether their rotor is wound and damps no harmonic field.

    shape: of its slots.
    """

    name: str
    winding: SlotWinding
    poles: int = 4
    wound_rotor: bool = False
    connection: Connection = Connection.STAR
    shape: SlotShape = USUAL_SLOTS

    def motors(self, *, quick: bool) -> Iterator[Motor]:
        """Motors with this winding."""
        for power_kW in POWERS_KW[1:2] if quick else POWERS_KW:
            motor = rated_motor(power_kW, self.poles, self.connection)
            yield replace(motor, wound_rotor=ROTOR) if self.wound_rotor else motor

    def coils_and_shares(self) -> Iterator[tuple[int, float]]:
        """Each coil of a group, with the shares of its turns that are shorted."""
        for place in range(1, self.winding.coils_per_group(self.poles // 2) + 1):
            for share in SHARES:
                yield place, share

    def axis_and_link(self, coil: int) -> tuple[float, float]:
        """Angle of a coil's axis from its phase's [rad], and what it links over the phase's mean turn.

        A lap winding has coils (i - (q - 1)/2) slots from the middle of their group, that link 1/k_d. A
        concentric one has them in the middle, and they link in proportion to the sine of half their pitch.
        """
        q = self.winding.coils_per_group(self.poles // 2)
        slot = pi * self.poles / self.winding.slots
        if self.winding.kind == "concentric":
            pitch = self.winding.coil_pitch_slots or self.winding.slots // self.poles
            links = [sin((pitch + q - 1 - 2 * i) * slot / 2) for i in range(q)]
            return 0.0, links[coil - 1] * q / sum(links)
        k_d = sin(q * slot / 2) / (q * sin(slot / 2))
        return (coil - 1 - (q - 1) / 2) * slot, 1.0 / k_d


WINDINGS = (
    Case("lap 36/4, pitch 8/9", SlotWinding("lap", 36, 2, 8)),
    Case("lap 36/4, full pitch", SlotWinding("lap", 36, 2, 9)),
    Case("lap 48/4, 10/12", SlotWinding("lap", 48, 2, 10)),
    Case("lap 24/4, 5/6", SlotWinding("lap", 24, 2, 5)),
    Case("lap 54/6, 8/9", SlotWinding("lap", 54, 2, 8), poles=6),
    Case("lap 36/2, 15/18", SlotWinding("lap", 36, 2, 15), poles=2),
    Case("concentric 36/4, one layer", SlotWinding("concentric", 36, 1)),
    Case("lap 36/4, 8/9, in delta", SlotWinding("lap", 36, 2, 8), connection=Connection.DELTA),
    Case("lap 36/4, 8/9, 2 branches", SlotWinding("lap", 36, 2, 8, branches=2)),
    Case("lap 36/4, 8/9, 4 branches", SlotWinding("lap", 36, 2, 8, branches=4)),
    Case("lap 36/4, 8/9, slip rings", SlotWinding("lap", 36, 2, 8), wound_rotor=True),
    Case("concentric 36/4, slip rings", SlotWinding("concentric", 36, 1), wound_rotor=True),
)

SHAPES = tuple(
    Case(f"{name}, {words}", winding, shape=shape)
    for name, winding in (
        ("lap 36/4, 8/9", SlotWinding("lap", 36, 2, 8)),
        ("concentric 36/4", SlotWinding("concentric", 36, 1)),
    )
    for words, shape in (
        ("flat slots", SlotShape(layer_height=0.7)),
        ("deep slots", SlotShape(layer_height=2.0)),
        ("wide opening", SlotShape(opening=0.2)),
        ("narrow opening", SlotShape(opening=1.5)),
        ("short ends", SlotShape(end_share=0.1)),
        ("long ends", SlotShape(end_share=0.5)),
    )
)
"""Slots and ends of other shapes; the usual one has layers 1.2 high, an opening of 0.6 and 25 % ends."""
