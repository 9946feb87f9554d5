"""What a motor does in a recording is told from its currents, on either side of the contactor."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from core.commissioning.errors import CommissioningError
from core.commissioning.start_detection import start_of
from core.diagnosis.errors import NoVoltagesError
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.machines.parameters import Motor
from core.operation import Operation
from core.recordings import Digitals, Recording
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import recording, running
from testing.machines.starts import StartRecord

Array = NDArray[np.float64]

RATE = 10_000.0
CYCLE = 200
AMPS, VOLTS = slice(0, 3), slice(3, 6)
START = StartRecord(load_level=0.4, duration_s=0.7, before_s=0.08, snr_db=40.0, voltage_snr_db=50.0)


@cache
def started(**how: object) -> Recording:
    return replace(START, **how).of(REFERENCE)  # type: ignore[arg-type]


@cache
def steady(load: float = 0.6) -> Recording:
    return recording(running(REFERENCE, load), noise=0.002)


def of(record: Recording, samples: Array, digitals: Digitals | None = None) -> Recording:
    return replace(record, samples=samples, digitals=digitals, trigger_index=None)


def noise(shape: tuple[int, ...], size: float, seed: int = 3) -> Array:
    return np.asarray(size * np.random.default_rng(seed).standard_normal(shape))


def standing(amps: Array | float, *, live: bool = True) -> Recording:
    """A motor that stands: its currents, before the voltage of the bus or behind the contactor."""
    record = steady()
    samples = record.samples.copy()
    samples[AMPS] = amps
    if not live:
        samples[VOLTS] = noise(samples[VOLTS].shape, 0.05)
    return of(record, samples)


def hum(size: float) -> Array:
    """Of the supply's frequency, and another in each channel."""
    t = np.arange(steady().samples.shape[1]) / RATE
    waves = [
        share * np.sin(2 * np.pi * 50.0 * t + phase) for share, phase in ((1.0, 0.0), (0.7, 0.4), (0.3, 2.0))
    ]
    return np.asarray(size * np.array(waves) + noise((3, t.size), size / 5))


def counts(samples: Array, step: float) -> Array:
    """What a converter makes of samples: whole counts, of which noise at rest has hardly any."""
    return np.asarray(step * np.round(samples / step))


def stopped(*, residual: bool, rest: float = 0.002, at: int = 4_030) -> Recording:
    """A motor that is switched off: behind the contactor, its terminals keep a voltage that dies away."""
    record = steady()
    samples = record.samples.copy()
    behind = np.arange(samples.shape[1] - at) / RATE
    samples[AMPS, at:] = noise((3, behind.size), rest)
    samples[AMPS, at:] += np.array([[0.2], [-0.1], [-0.1]]) * np.exp(
        -behind / 0.05
    )  # of the transformers' cores
    if residual:
        angle = 2 * np.pi * (50.0 * behind - 40.0 * behind**2)
        for k, phase in enumerate((0.0, -2.1, 2.1)):
            samples[3 + k, at:] = 300.0 * np.exp(-behind / 0.08) * np.sin(angle + phase)
    return of(record, samples)


def in_steps() -> Recording:
    """From star to delta, with a pause of 40 ms."""
    record = started(busbar=True)
    star = record.samples.copy()
    star[AMPS] /= 3.0
    star[AMPS, -400:] = noise((3, 400), 0.01)
    behind = record.samples[:, round(0.08 * RATE) :]
    return of(record, np.hstack([star, behind]))


def ramped(record: Recording, cycles: float) -> Recording:
    """Through a soft starter."""
    samples = record.samples.copy()
    first = round(0.08 * RATE)
    samples[AMPS, first:] *= np.minimum(1.0, 0.15 + np.arange(samples.shape[1] - first) / (cycles * CYCLE))
    return of(record, samples)


def driven() -> Recording:
    """Through a drive, whose frequency rises; the voltage is that of the bus."""
    record = steady()
    samples = record.samples.copy()
    t = np.arange(samples.shape[1]) / RATE - 0.08
    turn = 2 * np.pi * 40.0 * np.maximum(t, 0.0) ** 2
    for k, phase in enumerate((0.0, -2.1, 2.1)):
        samples[k] = 2.5 * np.sin(turn + phase) * (t > 0) * np.minimum(1.0, np.maximum(t, 0.0) / 0.3)
    samples[AMPS] += noise(samples[AMPS].shape, 0.01)
    return of(record, samples)


def jogged() -> Recording:
    record = started()
    samples = record.samples.copy()
    samples[AMPS, 4_000:] = noise((3, samples.shape[1] - 4_000), 0.005)
    return of(record, samples)


def with_states(record: Recording, **first: int) -> Recording:
    """States that rise at a sample."""
    rising = np.arange(record.samples.shape[1])[:, np.newaxis] >= np.array([list(first.values())])
    names = tuple(name.replace("__", ".").replace("_", " ") for name in first)
    return replace(record, digitals=Digitals.of(names, rising))


def scaled_down(record: Recording, share: float) -> Recording:
    return of(record, record.samples * np.array([[share]] * 3 + [[1.0]] * 3))


DOES: list[tuple[str, Operation | None, Callable[[], Recording]]] = [
    ("running", Operation.RUNNING, steady),
    ("running light", Operation.RUNNING, lambda: steady(0.0)),
    ("a start behind the contactor", Operation.START, started),
    ("a start, voltage of the bus", Operation.START, lambda: started(busbar=True)),
    ("a start, two line voltages", Operation.START, lambda: started(lines=True)),
    ("a start, the other way round", Operation.START, lambda: started(sequence="acb")),
    ("a start, 16 samples a cycle", Operation.START, lambda: started(sample_rate_hz=800.0)),
    ("a start without load", Operation.START, lambda: started(load_level=0.0)),
    ("a start with noise", Operation.START, lambda: started(snr_db=25.0)),
    ("a start, nothing at all at rest", Operation.START, lambda: started(snr_db=None, voltage_snr_db=None)),
    ("a start in whole counts", Operation.START, lambda: of(started(), counts(started().samples, 0.4))),
    ("a start that goes on", Operation.START, lambda: of(started(), started().samples[:, :1_800])),
    ("a start that began before", Operation.START, lambda: of(started(), started().samples[:, 1_100:])),
    ("a start in secondary amperes", Operation.START, lambda: scaled_down(started(), 0.02)),
    ("from star to delta", Operation.START, in_steps),
    ("a soft starter", Operation.START, lambda: ramped(started(busbar=True), 15)),
    ("a drive", Operation.START, driven),
    ("standing, noise", Operation.NOT_RUNNING, lambda: standing(noise((3, 6_000), 0.005))),
    ("standing, counts", Operation.NOT_RUNNING, lambda: standing(counts(noise((3, 6_000), 0.005), 0.01))),
    ("standing, hum", Operation.NOT_RUNNING, lambda: standing(hum(0.03))),
    ("standing, offsets", Operation.NOT_RUNNING, lambda: standing(np.full((3, 6_000), 0.1))),
    ("standing, nothing", Operation.NOT_RUNNING, lambda: standing(0.0)),
    ("standing, dead", Operation.NOT_RUNNING, lambda: standing(noise((3, 6_000), 0.02), live=False)),
    ("a stop, voltage of the bus", Operation.STOP, lambda: stopped(residual=False)),
    ("a stop behind the contactor", Operation.STOP, lambda: stopped(residual=True)),
    ("a stop, noise", Operation.STOP, lambda: stopped(residual=True, rest=0.03)),
    ("on and off", Operation.STOP, jogged),
    ("a trip", Operation.TRIP, lambda: with_states(stopped(residual=True), TRIP=3_500)),
    ("a trip of a phase", Operation.TRIP, lambda: with_states(stopped(residual=False), ER=10, Trip_A=3_900)),
    ("a trip of the standard's", Operation.TRIP, lambda: with_states(
        stopped(residual=False), PROT_PTRC1__Tr=3_900)),
    ("a trip of an element", Operation.TRIP, lambda: with_states(stopped(residual=False), JAMTRIP=3_900)),
    ("a stop, a retrip", Operation.STOP, lambda: with_states(stopped(residual=False), RETRIP=3_900)),
    ("a trip in a start", Operation.TRIP, lambda: with_states(jogged(), TRIP=3_800)),
    ("a trip that the record ends before", Operation.TRIP, lambda: with_states(steady(), TRIP=5_900)),
    ("a stop by command", Operation.STOP, lambda: with_states(
        stopped(residual=True), STOP=3_400, TRIP=3_400)),
    ("a stop, an alarm", Operation.STOP, lambda: with_states(
        stopped(residual=True), Trip_circuit_alarm=3_500)),
    ("standing after a trip", Operation.NOT_RUNNING, lambda: with_states(standing(hum(0.01)), TRIP=0)),
    ("running, kiloamperes", None, lambda: scaled_down(steady(), 1e-3)),
    ("running, secondary amperes", None, lambda: scaled_down(steady(), 0.02)),
]  # fmt: skip


@pytest.mark.parametrize(("does", "made"), [row[1:] for row in DOES], ids=[row[0] for row in DOES])
def test_what_the_motor_does_is_told(does: Operation | None, made: Callable[[], Recording]) -> None:
    found = diagnose(made(), REFERENCE)
    assert found.operation is does, found.reasons
    assert found.as_dict()["operation"] == does


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("load", [0.0, 1.0])
def test_starts_of_motors_of_all_sizes_are_told(motor: Motor, load: float) -> None:
    record = replace(START, load_level=load, sample_rate_hz=2_000.0).of(motor)
    assert diagnose(record, motor).operation is Operation.START


LOST: list[tuple[str, Callable[[], Array]]] = [
    ("in between", lambda: blank(steady().samples, 2_000, 3_000)),
    ("at the beginning", lambda: blank(steady().samples, 0, 1_500)),
    ("frozen at the end", lambda: frozen(steady().samples, 4_037)),
]


def blank(samples: Array, first: int, last: int) -> Array:
    samples = samples.copy()
    samples[:, first:last] = 0.0
    return samples


def frozen(samples: Array, first: int) -> Array:
    samples = samples.copy()
    samples[:, first:] = samples[:, first : first + 1]
    return samples


@pytest.mark.parametrize("made", [row[1] for row in LOST], ids=[row[0] for row in LOST])
def test_samples_that_are_lost_are_no_start_and_no_stop(made: Callable[[], Array]) -> None:
    found = diagnose(of(steady(), made()), REFERENCE)
    assert found.operation is None
    assert found.reasons[0].startswith("held samples")


def test_a_trip_in_steady_running_is_diagnosed_as_well() -> None:
    found = diagnose(with_states(steady(), TRIP=5_900), REFERENCE)
    assert (found.operation, found.verdict) == (Operation.TRIP, Verdict.HEALTHY)


def test_a_start_long_before_the_end_is_told_beside_the_verdict() -> None:
    record = StartRecord(load_level=0.4, duration_s=4.0, before_s=0.1, snr_db=45.0).of(REFERENCE)
    found = diagnose(record, REFERENCE)
    assert (found.operation, found.verdict) == (Operation.START, Verdict.HEALTHY)


def test_a_reason_says_plainly_what_helps() -> None:
    def reason(record: Recording) -> str:
        return diagnose(record, REFERENCE).reasons[0]

    assert "`mcc commission` estimates the motor's parameters" in reason(started())
    assert "`schedule_only_running`" in reason(standing(0.0))
    assert "record again while it runs" in reason(stopped(residual=True))
    assert reason(with_states(stopped(residual=True), TRIP=3_900)).startswith(
        "trip: the relay trips the motor"
    )


def test_a_current_that_begins_without_an_inrush_is_not_sent_to_the_commissioning() -> None:
    samples = steady(0.6).samples.copy()
    samples[AMPS, :CYCLE] = noise((3, CYCLE), 0.002)
    record = of(steady(), samples)
    (reason, *_) = diagnose(record, REFERENCE).reasons
    assert "without an inrush" in reason
    assert "estimates" not in reason
    with pytest.raises(CommissioningError, match="an inrush of at least"):
        start_of(record, REFERENCE.nameplate, REFERENCE.channels)


UNSUPPORTED: list[tuple[str, str, Callable[[], Recording]]] = [
    ("star-delta", "interrupted 0.7", in_steps),
    ("soft starter", "soft starter, a drive", lambda: ramped(started(busbar=True), 15)),
    ("on and off", "switched off again", jogged),
    ("began before", "began before the record", lambda: of(started(), started().samples[:, 1_100:])),
]


@pytest.mark.parametrize(
    ("why", "made"), [row[1:] for row in UNSUPPORTED], ids=[row[0] for row in UNSUPPORTED]
)
def test_a_start_that_no_parameters_follow_from_is_refused_as_such(
    why: str, made: Callable[[], Recording]
) -> None:
    with pytest.raises(CommissioningError, match=why):
        start_of(made(), REFERENCE.nameplate, REFERENCE.channels)


def without_voltages(record: Recording) -> Recording:
    return replace(record, samples=record.samples[AMPS], channels=record.channels[AMPS])


@pytest.mark.parametrize(
    ("does", "made"),
    [
        (Operation.NOT_RUNNING, lambda: standing(hum(0.03))),
        (Operation.START, started),
        (Operation.STOP, lambda: stopped(residual=False)),
    ],
)
def test_what_a_motor_does_is_told_without_voltages(does: Operation, made: Callable[[], Recording]) -> None:
    found = diagnose(without_voltages(made()), REFERENCE)
    assert (found.operation, found.verdict) == (does, Verdict.UNDIAGNOSABLE)
    assert "voltage" not in found.reasons[0]


def test_a_running_motor_needs_its_voltages() -> None:
    with pytest.raises(NoVoltagesError):
        diagnose(without_voltages(steady()), REFERENCE)
