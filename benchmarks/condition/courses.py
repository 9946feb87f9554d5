"""What happens to a motor and its channels over its records: faults, and everything that is none."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.condition.circuit import Array, Complex, Windings
from benchmarks.condition.population import SimulatedMotor, draw_channels, draw_windings


@dataclass(frozen=True, slots=True)
class Course:
    """The state of everything that changes, one row a record.

    voltage_ratio, current_ratio: of the channels beside what their sensors have from the beginning, (n, 3).
    line_resistance_ohm: of joints in the lines of the machine's frame, (n, 3).  level: equivalent level of
    shorted turns.  path_ratio: resistance of their path over theirs.  winding: in the machine's frame.
    unbalance: what comes to V2/V1.  recorder: number of the relay, as its records tell.
    rewound: from which record on the windings are others.  beside: admittance of what hangs between the lines
    behind the relay's transformers, beside the motor, (n, 3, 3) [S].  second: another motor there, and the
    record from which it runs.
    """

    voltage_ratio: Complex
    current_ratio: Complex
    line_resistance_ohm: Array
    level: Array
    path_ratio: Array
    winding: int
    unbalance: Complex
    recorder: NDArray[np.int64]
    rewound: tuple[int, Windings] | None = None
    beside: Complex | None = None
    second: tuple[int, SimulatedMotor] | None = None

    def __len__(self) -> int:
        return self.level.size


def healthy(records: int) -> Course:
    """Nothing happens."""
    ones = np.ones((records, 3), dtype=np.complex128)
    none = np.zeros(records)
    return Course(
        voltage_ratio=ones,
        current_ratio=ones.copy(),
        line_resistance_ohm=np.zeros((records, 3)),
        level=none,
        path_ratio=none.copy(),
        winding=0,
        unbalance=np.zeros(records, dtype=np.complex128),
        recorder=np.zeros(records, dtype=np.int64),
    )


def shape(records: int, first: int, length: int = 0) -> Array:
    """0 before a record, 1 from it on; with a length it rises in a straight line over so many records."""
    since = np.arange(records) - first
    return (since >= 0).astype(np.float64) if length == 0 else np.clip((since + 1) / length, 0.0, 1.0)


def with_fault(course: Course, winding: int, level: Array, path_ratio: float) -> Course:
    """Shorted turns of an equivalent level at every record."""
    return replace(course, winding=winding, level=level, path_ratio=np.full(level.size, path_ratio))


def with_voltage_error(course: Course, channel: int, size: complex, course_of_it: Array) -> Course:
    """A voltage channel that comes to read so much more."""
    return replace(course, voltage_ratio=_changed(course.voltage_ratio, channel, size, course_of_it))


def with_current_error(course: Course, channel: int, size: complex, course_of_it: Array) -> Course:
    """A current channel that comes to read so much more."""
    return replace(course, current_ratio=_changed(course.current_ratio, channel, size, course_of_it))


def with_joint(course: Course, line: int, ohm: float, course_of_it: Array) -> Course:
    """A joint in a line that gets more resistance."""
    lines = course.line_resistance_ohm.copy()
    lines[:, line] += ohm * course_of_it
    return replace(course, line_resistance_ohm=lines)


def with_unbalance(course: Course, size: complex, course_of_it: Array) -> Course:
    """A supply whose V2/V1 becomes another."""
    return replace(course, unbalance=course.unbalance + size * course_of_it)


def with_other_relay(
    random: np.random.Generator, course: Course, simulated: SimulatedMotor, first: int, *, announced: bool
) -> Course:
    """Another relay of the same class, whose records say so or not."""
    frequency = simulated.motor.nameplate.rated_frequency_Hz
    other = draw_channels(random, simulated.sensors, frequency)
    later = shape(len(course), first)[:, np.newaxis] > 0.0
    old = simulated.channels
    recorder = course.recorder.copy()
    recorder[first:] += int(announced)
    return replace(
        course,
        voltage_ratio=course.voltage_ratio * np.where(later, other.voltage / old.voltage, 1.0),
        current_ratio=course.current_ratio * np.where(later, other.current / old.current, 1.0),
        recorder=recorder,
    )


def with_rewinding(
    random: np.random.Generator, course: Course, simulated: SimulatedMotor, first: int, span: float = 0.1
) -> Course:
    """Another winding of nearly the same figures, which nobody tells of."""
    old = simulated.windings
    figures = np.array(
        [
            old.stator_resistance_ohm[0] * random.uniform(1 - span, 1 + span),
            old.rotor_resistance_ohm[0],
            old.stator_leakage_H[0] * random.uniform(1 - span, 1 + span),
            old.rotor_leakage_H[0],
            old.magnetising_H[0] * random.uniform(1 - span / 3, 1 + span / 3),
        ]
    )
    w = simulated.motor.nameplate.rated_angular_frequency
    other = draw_windings(random, figures, w, float(old.backward_resistance[0]) - 1.0)
    return replace(course, rewound=(first, other))


def _changed(ratio: Complex, channel: int, size: complex, course_of_it: Array) -> Complex:
    changed = ratio.copy()
    changed[:, channel] *= 1.0 + size * course_of_it
    return changed
