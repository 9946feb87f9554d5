"""The quality gate: named checks with figures, before any model sees the recording.

A check that fails makes the recording undiagnosable, with its figure and limit as the reason; it never
changes a sample. Limits are stated beside their reasons.
"""

from collections.abc import Iterator

import numpy as np

from core.diagnosis.verdict import QualityFinding
from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.signals.clarke import clarke
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_phasors
from core.signals.sequence import SequencePhasors, sequence_phasors
from core.signals.terminals import Terminals

FEWEST_CYCLES = 4.9
"""Delay margin, settling and the fewest cycles a scatter can be taken from."""
FREQUENCY_TOLERANCE = 0.06
LOWEST_VOLTAGE, HIGHEST_VOLTAGE = 0.5, 1.3
"""Positive-sequence voltage over rated: below, the motor is starting or off; above, the scaling is wrong."""
LOWEST_CURRENT = 0.05
"""Of rated apparent power's current: no motor magnetises with less."""
HIGHEST_CURRENT = 3.0
"""Of the same: above, the motor is starting or the scaling is wrong."""
CLIPPED_SHARE = 0.001
HELD_RUN_CYCLES = 0.15
"""Longest run of equal samples: a quarter cycle holds the crest of a sine at least to the last digit."""
PHASE_LOSS = 0.1
"""Least over greatest of the three phase currents, below which one is missing or open."""
SWAPPED_SHARE = 0.6
"""Backward over forward current: a lightly loaded motor on an unbalanced supply may come near 1, but then the
currents' sequence says nothing; swapped phases leave a small share."""
ZERO_SEQUENCE = 0.06
"""Fundamental of the currents' sum over their mean: a three-wire motor's currents add up to nothing, so the
sum shows what their sensors are off by; class 5P at its limit and 50 us between channels leave 3 %."""
ZERO_SEQUENCE_UNPAIRED = 0.3
"""The same where no voltages were recorded: such currents often come from sensors scaled one by one, and the
verdict is a hint at best."""
DRIFT = 0.15
"""Relative change of the positive-sequence current from the first to the last third of the record."""
EFFICIENCY_TIMES_POWER_FACTOR = 0.6
"""Typical of small motors; only for the order of magnitude of the rated current."""


def sampled_well(terminals: Terminals, nameplate: Nameplate) -> list[QualityFinding]:
    """Checks on the samples themselves; the rest is computed only where these pass."""
    return list(_sample_checks(terminals, nameplate))


def electrical_condition(
    terminals: Terminals, voltage_ab: Array, frequency_hz: float, nameplate: Nameplate
) -> list[QualityFinding]:
    """Checks on frequency, voltages and currents of a record whose samples are sound."""
    return list(_electrical_checks(terminals, voltage_ab, frequency_hz, nameplate))


def no_frequency(error: SignalError, nameplate: Nameplate) -> QualityFinding:
    """The finding where the voltages have no fundamental at all."""
    return _finding("frequency", 0.0, nameplate.rated_frequency_Hz, "Hz", passed=False, message=str(error))


def rated_current_A(nameplate: Nameplate) -> float:
    """Order of magnitude of the rated line current, rms, from power and voltage [A]."""
    apparent = nameplate.rated_power_W / EFFICIENCY_TIMES_POWER_FACTOR
    return float(apparent / (np.sqrt(3.0) * nameplate.rated_voltage_V))


def _sample_checks(terminals: Terminals, nameplate: Nameplate) -> Iterator[QualityFinding]:
    rate = terminals.sample_rate_hz
    current, voltage = terminals.current_abc, terminals.voltage_ab
    both = current if voltage is None else np.concatenate([current, voltage])
    missing = int(both.size - np.count_nonzero(np.isfinite(both)))
    yield _finding(
        "missing samples", missing, 0, "samples", missing == 0, "samples are missing or not numbers"
    )

    cycles = current.shape[1] / rate * nameplate.rated_frequency_Hz
    yield _finding(
        "duration", cycles, FEWEST_CYCLES, "cycles", cycles >= FEWEST_CYCLES, "the record is too short"
    )

    per_cycle = rate / nameplate.rated_frequency_Hz
    yield _finding("sample rate", per_cycle, 12.0, "samples a cycle", per_cycle >= 12.0, "sampled too slowly")

    for channel, samples in zip(terminals.current_channels, current, strict=True):
        if channel.full_scale is not None and samples.size:
            share = float(np.mean(np.abs(samples) >= 0.999 * channel.full_scale))
            yield _finding(
                f"clipping {channel.name}", share, CLIPPED_SHARE, "share", share <= CLIPPED_SHARE,
                f"{channel.name} sits at its full scale of {channel.full_scale:g} {channel.unit}",
            )  # fmt: skip
    if per_cycle >= 32.0:
        for channel, samples in zip(terminals.current_channels, current, strict=True):
            run = _longest_run(samples) / per_cycle
            yield _finding(
                f"held samples {channel.name}", run, HELD_RUN_CYCLES, "cycles", run <= HELD_RUN_CYCLES,
                f"{channel.name} repeats one value",
            )  # fmt: skip


def _electrical_checks(
    terminals: Terminals, voltage_ab: Array, frequency: float, nameplate: Nameplate
) -> Iterator[QualityFinding]:
    rate = terminals.sample_rate_hz
    rated = nameplate.rated_frequency_Hz
    deviation = abs(frequency / rated - 1.0)
    yield _finding(
        "frequency", frequency, rated, "Hz", deviation <= FREQUENCY_TOLERANCE,
        f"{frequency:.2f} Hz is not the rated {rated:g} Hz within {FREQUENCY_TOLERANCE:.0%}; fed by a drive?",
    )  # fmt: skip

    volts, _ = _stronger(sequence_phasors(fundamental_phasors(voltage_ab, frequency, rate)))
    volts *= np.sqrt(3.0) / nameplate.rated_voltage_V
    in_range = LOWEST_VOLTAGE <= volts <= HIGHEST_VOLTAGE
    yield _finding(
        "voltage", volts, LOWEST_VOLTAGE, "of rated", in_range,
        f"{volts:.0%} of the rated voltage: the motor is off, starting, or the voltages are scaled wrongly",
    )  # fmt: skip

    current_ab = clarke(terminals.current_abc)
    current = sequence_phasors(fundamental_phasors(current_ab, frequency, rate))
    voltage = sequence_phasors(fundamental_phasors(voltage_ab, frequency, rate))
    strong, weak = _stronger(current)
    amps = strong / rated_current_A(nameplate)
    yield _finding(
        "current", amps, LOWEST_CURRENT, "of rated", LOWEST_CURRENT <= amps <= HIGHEST_CURRENT,
        f"{amps:.0%} of the rated current: the motor is off, starting, or the currents are scaled wrongly",
    )  # fmt: skip

    magnitudes = np.abs(fundamental_phasors(terminals.current_abc, frequency, rate))
    least = float(magnitudes.min() / max(magnitudes.max(), 1e-12))
    yield _finding(
        "phase loss",
        least,
        PHASE_LOSS,
        "of the greatest",
        least >= PHASE_LOSS,
        "a current phase is missing or open",
    )

    share = weak / max(strong, 1e-12)
    swapped = current.sequence is not voltage.sequence and share < SWAPPED_SHARE
    yield _finding(
        "phase order", share, SWAPPED_SHARE, "backward over forward", not swapped,
        "the currents turn against the voltages: two phases are swapped",
    )  # fmt: skip

    total = abs(complex(fundamental_phasors(terminals.current_abc.sum(axis=0), frequency, rate)))
    zero = total / max(float(magnitudes.mean()), 1e-12)
    most = ZERO_SEQUENCE if terminals.voltage_ab is not None else ZERO_SEQUENCE_UNPAIRED
    yield _finding(
        "current sum", zero, most, "of one phase", zero <= most,
        "the three currents do not add up to nothing: one is missing, reversed or scaled wrongly",
    )  # fmt: skip

    power = _power(voltage, current)
    yield _finding(
        "power direction",
        power,
        0.0,
        "W",
        power > 0.0,
        "power flows out of the motor: current polarity reversed?",
    )

    third = current_ab.shape[1] // 3
    early, _ = _stronger(sequence_phasors(fundamental_phasors(current_ab[:, :third], frequency, rate)))
    late, _ = _stronger(sequence_phasors(fundamental_phasors(current_ab[:, -third:], frequency, rate)))
    drift = abs(late - early) / max(strong, 1e-12)
    yield _finding(
        "steadiness",
        drift,
        DRIFT,
        "of the current",
        drift <= DRIFT,
        "the load or the supply changes in the record",
    )


def _stronger(phasors: SequencePhasors) -> tuple[float, float]:
    weak, strong = sorted((abs(phasors.positive), abs(phasors.negative)))
    return strong, weak


def _power(voltage: SequencePhasors, current: SequencePhasors) -> float:
    positive = voltage.positive * current.positive.conjugate()
    negative = voltage.negative * current.negative.conjugate()
    return 3.0 * (positive + negative).real


def _longest_run(samples: Array) -> int:
    """Length of the longest run of equal neighbours."""
    changes = np.flatnonzero(np.diff(samples) != 0.0)
    return int(np.diff(np.concatenate([[-1], changes, [samples.size - 1]])).max(initial=0))


def _finding(name: str, value: float, limit: float, unit: str, passed: bool, message: str) -> QualityFinding:
    return QualityFinding(name, float(value), float(limit), unit, bool(passed), "" if passed else message)
