"""What a record and the memory of its motor's lines tell of the speed, and what the memory learns from it."""

from dataclasses import dataclass, replace
from math import hypot, sqrt
from typing import Final

from core.normal_distribution import NORMAL_95
from core.speed.finding import SpeedAlternative, SpeedFinding, SpeedSource, SpeedState
from core.speed.memory import LineMemory
from core.speed.record import SpeedRecord
from core.speed.search import ALL_SLIPS, HIGHEST_SLIP, find_peak

MOST_CANDIDATES: Final = 8
"""Numbers of bars whose speeds are looked for; the likeliest where more are possible."""
FEWEST_SEEN: Final = 0.5
"""Share of a record's pieces in which the speed has to be seen."""
LEAST_SHOWN: Final = 0.5
"""Share of the slots' lines that have to lie within the band: a few alone lock on to foreign ones."""
COMMON: Final = 2.5e-5
"""Standard deviation of an error that all pieces of a record share, over the speed."""
SLIP_RANGE: Final = 1.7
"""Factor by which a slip may lie beside the model's: rotors are warm or cold, files are not exact."""
SLIP_ALLOWANCE: Final = 2e-3
"""The same beside it, for motors that hardly slip."""


@dataclass(frozen=True, slots=True)
class _Seen:
    """The speed of a record with one number of bars."""

    bars: int
    rotation_hz: float
    deviation_hz: float
    slip: float
    margin: float

    def differs(self, other: "_Seen") -> bool:
        """Return whether two speeds are told apart by their intervals."""
        apart = abs(self.rotation_hz - other.rotation_hz)
        return apart > NORMAL_95 * max(self.deviation_hz, other.deviation_hz)

    def alternative(self) -> SpeedAlternative:
        """Return the speed as it is shown."""
        half = NORMAL_95 * self.deviation_hz
        low, high = 60.0 * (self.rotation_hz - half), 60.0 * (self.rotation_hz + half)
        return SpeedAlternative(self.bars, 60.0 * self.rotation_hz, (low, high))


def tell_speed(
    record: SpeedRecord, memory: LineMemory, *, model_slip: float | None = None, is_model_sure: bool = True
) -> SpeedFinding:
    """Tell the speed of a record from its currents.

    Parameters
    ----------
    record : SpeedRecord
        The record.
    memory : LineMemory
        What is known of the motor's lines; without any, the record's own evidence counts.
    model_slip : float or None, optional
        Slip by the model.
    is_model_sure : bool, default True
        Whether a speed far from the model's is a false one. It is not where the parameters are typical ones.

    Returns
    -------
    SpeedFinding
        The speed with its interval; where it is not seen, that of the model.
    """
    if not memory.candidates:
        memory = replace(memory, evidence=[record.evidence()])
    possible = _possible_slips(model_slip if is_model_sure else None)
    found, beside = [], None
    for bars in memory.candidates[:MOST_CANDIDATES]:
        seen = _seen(record, memory, bars, possible)
        if seen is None:
            continue
        if not possible[0] <= seen.slip <= possible[1]:
            beside = seen
            continue
        found.append(seen)
    model_rpm = None
    if model_slip is not None:
        model_rpm = 60.0 * record.frequency_hz * (1.0 - model_slip) / record.pole_pairs
    without = not_seen(_why_not(memory, beside, model_slip), model_slip, model_rpm)
    if not found:
        return without
    first = found[0]
    others = [other for other in found[1:] if other.differs(first)]
    if others:
        alternatives = tuple(one.alternative() for one in (first, *others))
        return replace(
            without,
            state=SpeedState.ALTERNATIVES,
            alternatives=alternatives,
            reasons=(
                f"lines of the rotor are seen, but {len(alternatives)} numbers of bars explain them: more "
                "recordings at other loads tell them apart, or rotor_bars in the motor file does",
            ),
        )
    speed = first.alternative()
    return replace(
        without,
        state=SpeedState.SEEN,
        source=SpeedSource.CURRENT,
        speed_rpm=speed.speed_rpm,
        speed_rpm_ci95=speed.speed_rpm_ci95,
        slip=first.slip,
        rotor_bars=first.bars,
        margin=first.margin,
        reasons=_beside_model(first, model_slip),
    )


def learn(record: SpeedRecord, finding: SpeedFinding, memory: LineMemory) -> None:
    """Have the memory learn from a record.

    Parameters
    ----------
    record : SpeedRecord
        The record.
    finding : SpeedFinding
        What was told of it with this memory.
    memory : LineMemory
        The memory of its motor; it changes.
    """
    if memory.given_bars is None and finding.state is not SpeedState.NOT_SEEN and memory.known_bars is None:
        memory.weigh(record.evidence())
    bars = memory.known_bars
    if bars is None or finding.state is not SpeedState.SEEN or finding.rotor_bars != bars:
        return
    comb = memory.comb(bars)
    for piece in record.pieces:
        peak = find_peak(piece, comb, record.pole_pairs)
        if peak.is_seen:
            memory.learn(piece, bars, peak.rotation_hz)


def not_seen(
    reason: str, model_slip: float | None = None, model_speed_rpm: float | None = None
) -> SpeedFinding:
    """Return the finding of a record whose currents do not show the speed.

    Parameters
    ----------
    reason : str
        Why.
    model_slip, model_speed_rpm : float or None, optional
        Slip and speed by the model, both or none.

    Returns
    -------
    SpeedFinding
        The speed of the model, where there is one.
    """
    return SpeedFinding(
        state=SpeedState.NOT_SEEN,
        source=None if model_speed_rpm is None else SpeedSource.MODEL,
        speed_rpm=model_speed_rpm,
        speed_rpm_ci95=None,
        slip=model_slip,
        model_speed_rpm=model_speed_rpm,
        rotor_bars=None,
        margin=None,
        alternatives=(),
        reasons=(reason,),
    )


def _seen(
    record: SpeedRecord, memory: LineMemory, bars: int, possible_slips: tuple[float, float]
) -> _Seen | None:
    comb = memory.comb(bars)
    both = [(piece, find_peak(piece, comb, record.pole_pairs, possible_slips)) for piece in record.pieces]
    seen = [
        (piece, peak)
        for piece, peak in both
        if peak.is_seen and comb.share_shown(piece, peak.rotation_hz) >= LEAST_SHOWN
    ]
    if not seen or len(seen) < FEWEST_SEEN * len(both):
        return None
    count = len(seen)
    rotation_hz = sum(peak.rotation_hz for _, peak in seen) / count
    frequency_hz = sum(piece.frequency_hz for piece, _ in seen) / count
    peaks = [peak for _, peak in seen]
    return _Seen(
        bars,
        rotation_hz,
        hypot(sqrt(sum(peak.deviation_hz**2 for peak in peaks)) / count, COMMON * rotation_hz),
        1.0 - record.pole_pairs * rotation_hz / frequency_hz,
        min(peak.margin for peak in peaks),
    )


def _possible_slips(model_slip: float | None) -> tuple[float, float]:
    if model_slip is None:
        return ALL_SLIPS
    return model_slip / SLIP_RANGE - SLIP_ALLOWANCE, model_slip * SLIP_RANGE + SLIP_ALLOWANCE


def _why_not(memory: LineMemory, beside: _Seen | None, model_slip: float | None) -> str:
    if beside is not None and model_slip is not None:
        return (
            f"lines of a rotor with {beside.bars} bars would mean a slip of {beside.slip:.2%}, the model's "
            f"is {model_slip:.2%}: they are taken for others"
        )
    if memory.given_bars is not None:
        return (
            f"the lines of a rotor with {memory.given_bars} bars do not stand out from the noise, are hidden "
            "by harmonics, or lie above the band of the recording"
        )
    return f"no lines of a rotor stand out from the noise (slips up to {HIGHEST_SLIP:.0%} are looked at)"


def _beside_model(seen: _Seen, model_slip: float | None) -> tuple[str, ...]:
    if model_slip is None or model_slip <= 0.0:
        return ()
    return (
        f"the slip is {seen.slip / model_slip:.2f} times the model's: so does the rotor's resistance differ "
        "from the motor file's, as its temperature makes it, or the load's measurement",
    )
