"""What elements behind the relay's transformers, beside the motor, add to a record's figures.

An element Y between two lines draws as much negative as positive sequence, and so does one between a line and
the neutral, with a third of its current in each sequence. A bank of capacitors that lost elements of a branch
lacks just that: in delta an element between two lines, in star with a free star point half of a phase's. All
of them follow the voltage, not the load of the motor.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from core.diagnosis.causes import Cause
from core.diagnosis.record_errors import Element, RecordErrors
from core.diagnosis.signature import Signature
from core.machines.parameters import Connection
from core.machines.winding_frame import terminal_winding
from core.normal_distribution import NORMAL_95

LOADS: Final = (0.06, 0.2)
"""Usual currents of a load behind the relay, over the rated current of the motor."""
LOAD_ANGLE: Final = 0.2
"""How far they turn from their voltage, over their size: heaters, lighting."""
SHARES: Final = {Element.BETWEEN_LINES: 0.01, Element.TO_NEUTRAL: 0.001}
"""How often there is such a load, over how often a bank that there is has lost elements. Feeders of motors
have hardly any other load: they are rarer than an asymmetry of unknown cause."""
LOST: Final = (0.3, 1.0)
"""Usual shares of a capacitor's branch that are lost."""
LOST_ANGLE: Final = 0.02
RATED_EFFICIENCY_POWER_FACTOR: Final = 0.75
PHASES: Final = ("a", "b", "c")


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of element: which, its share, its usual size [S], how far it turns, and its size in words."""

    element: Element
    share: float
    usual_S: complex
    angle: float
    size_in_words: Callable[[float, float], str]


def loads_behind(errors: RecordErrors) -> list[Signature]:
    """Return the signatures of loads, and of capacitors that lost elements where there is a bank."""
    kinds, found = [*_loads(errors), *_lost_capacitors(errors)], list[Signature]()
    for x in range(3):
        for kind in kinds:
            columns = [errors.load(x, part * kind.usual_S, kind.element) for part in (1.0, 1j)]
            found.append(
                Signature(
                    Cause.BEHIND_RELAY,
                    _place(errors, x, kind.element),
                    np.stack(columns, axis=1),
                    np.array([1.0, kind.angle]),
                    one_sided=True,
                    share=kind.share / 3.0,
                    size_in_words=kind.size_in_words,
                )
            )
    return found


def _loads(errors: RecordErrors) -> list[_Kind]:
    plate = errors.motor.nameplate
    rated_S = plate.rated_power_W / (plate.rated_voltage_V**2 * RATED_EFFICIENCY_POWER_FACTOR)

    def words(usual: float) -> Callable[[float, float], str]:
        return lambda size, deviation: (
            f"a load of {max(size, 0.0) * usual:.1%} (+-{NORMAL_95 * deviation * usual:.1%}) of the motor's "
            "rated current"
        )

    return [
        _Kind(one, share / len(LOADS), usual * rated_S + 0j, LOAD_ANGLE, words(usual))
        for one, share in SHARES.items()
        for usual in LOADS
    ]


def _lost_capacitors(errors: RecordErrors) -> list[_Kind]:
    if errors.bank_S == 0.0:
        return []
    bank = errors.motor.capacitors
    connections = tuple(Connection) if bank is None else (bank.connection,)
    found = []
    for one in connections:
        delta = one is Connection.DELTA
        element, whole_S = (
            (Element.BETWEEN_LINES, errors.bank_S / 3.0)
            if delta
            else (Element.OF_FREE_STAR, errors.bank_S / 2.0)
        )
        share = 1.0 / (len(connections) * len(LOST))
        found += [
            _Kind(element, share, -1j * usual * whole_S, LOST_ANGLE, _lost_words(usual)) for usual in LOST
        ]
    return found


def _lost_words(usual: float) -> Callable[[float, float], str]:
    return lambda size, deviation: (
        f"a capacitor lost {max(size, 0.0) * usual:.0%} (+-{NORMAL_95 * deviation * usual:.0%}) of a branch"
    )


def _place(errors: RecordErrors, x: int, element: Element) -> str:
    own, one, two = (
        PHASES[terminal_winding(k % 3, errors.figures.sequence, Connection.STAR)] for k in (x, x + 1, x + 2)
    )
    if element is Element.BETWEEN_LINES:
        return f"between lines {min(one, two)} and {max(one, two)}"
    return f"line {own}" if element is Element.OF_FREE_STAR else f"between line {own} and the neutral"
