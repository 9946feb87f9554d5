"""Two recordings of one motor side by side: their figures, and their currents laid over one another."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.signals.terminals import PHASES
from service.api.context import ApiContext
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.storage.errors import NotFoundError
from service.storage.records import RecordingEntry
from service.waveforms.opened import Opened
from service.waveforms.phasors import NoPhasorsError, PhasorsAt, phasors_at
from service.web.charts import Chart, Kind, Series, Tone
from service.web.recording.verdicts import words_of
from service.web.words import NOTHING, figure

CYCLES: Final = 2.0
POINTS: Final = 361


@dataclass(frozen=True, slots=True)
class Line:
    """A figure of both, and what the first has more."""

    name: str
    here: str
    there: str
    difference: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """A recording beside another one of its motor. problem: why the currents are not laid over others."""

    other: RecordingEntry
    lines: tuple[Line, ...]
    chart: Chart | None
    problem: str


def comparison(context: ApiContext, entry: RecordingEntry, other_id: str) -> Comparison:
    """Compare with another recording of the motor. Raises NotFoundError, and as `Recorded.open`."""
    other = context.repository.recording(other_id)
    if other.motor != entry.motor:
        raise NotFoundError("recording of this motor", other_id)
    diagnoses = [_diagnosis(context, one.id) for one in (entry, other)]
    figures: list[tuple[PhasorsAt, NDArray[np.float64]] | None] = []
    problem = ""
    for one in (entry, other):
        try:
            figures.append(_cycles(context.recorded.open(one)))
        except NoPhasorsError as error:
            figures.append(None)
            problem = str(error)
    lines = [*_of_diagnoses(*diagnoses), *_of_phasors(*(one and one[0] for one in figures))]
    chart = None
    if figures[0] is not None and figures[1] is not None:
        chart = _chart(figures[0][1], figures[1][1])
    return Comparison(other, tuple(lines), chart, problem)


def _diagnosis(context: ApiContext, recording_id: str) -> Diagnosis | None:
    found = context.repository.current_diagnosis(recording_id)
    return None if found is None else Diagnosis.model_validate(found.document)


def _cycles(shown: Opened) -> tuple[PhasorsAt, NDArray[np.float64]]:
    """Return the phasors of the middle, and currents over some cycles from the reference's angle nought on.

    Raises NoPhasorsError.
    """
    found = phasors_at(shown, shown.recording.duration_s / 2.0)
    measured = shown.terminals()
    times = found.zero_angle_s + np.linspace(0.0, CYCLES, POINTS) / found.frequency_hz
    sampled = np.arange(measured.current_abc.shape[1]) / measured.sample_rate_hz
    currents = [np.interp(times, sampled, row, left=np.nan, right=np.nan) for row in measured.current_abc]
    return found, np.stack(currents)


def _chart(here: NDArray[np.float64], there: NDArray[np.float64]) -> Chart:
    series = []
    for phase, row in zip(PHASES, here, strict=True):
        series.append(Series(f"i{phase}", row.round(6).tolist(), "A", tone=Tone(phase)))
    for phase, row in zip(PHASES, there, strict=True):
        label = f"i{phase} of the other"
        series.append(Series(label, row.round(6).tolist(), "A", tone=Tone.MODEL, kind=Kind.THIN))
    return Chart(
        key="compared",
        caption="Currents of both, from the same angle of the supply on",
        summary="The lines of the other recording are thin and without dashes.",
        x_label="angle of the supply",
        x_unit="°",
        y_label="current",
        y_unit="A",
        x=np.linspace(0.0, 360.0 * CYCLES, POINTS).round(3).tolist(),
        series=series,
    )


def _of_diagnoses(here: Diagnosis | None, there: Diagnosis | None) -> list[Line]:
    verdicts = [words_of(None if one is None else one.verdict) for one in (here, there)]
    lines = [Line("verdict", verdicts[0], verdicts[1], "")]
    for name, field, factor, unit in (
        ("fault level", "mu_f", 100.0, "%"),
        ("load", "load_level", 100.0, "%"),
        ("speed", "speed_rpm", 1.0, "rpm"),
        ("residual", "residual_rms_A", 1.0, "A"),
    ):
        values = [_value(one, field, factor) for one in (here, there)]
        lines.append(_line(name, values[0], values[1], unit))
    return lines


def _of_phasors(here: PhasorsAt | None, there: PhasorsAt | None) -> list[Line]:
    frequencies = [None if one is None else one.frequency_hz for one in (here, there)]
    lines = [_line("frequency", frequencies[0], frequencies[1], "Hz", 5)]
    for name, unit in (("V1", "V"), ("V2", "V"), ("I1", "A"), ("I2", "A")):
        values = [None if one is None else one.component(name) for one in (here, there)]
        sizes = [None if value is None else abs(value) for value in values]
        lines.append(_line(name, sizes[0], sizes[1], unit, 4))
    factors = [None if one is None else one.power_factor for one in (here, there)]
    return [*lines, _line("power factor", factors[0], factors[1], "")]


def _value(diagnosis: Diagnosis | None, field: str, factor: float) -> float | None:
    value = None if diagnosis is None else getattr(diagnosis, field)
    return None if value is None else factor * float(value)


def _line(name: str, here: float | None, there: float | None, unit: str, digits: int = 3) -> Line:
    difference = NOTHING
    if here is not None and there is not None:
        difference = figure(here - there, unit)
    return Line(name, figure(here, unit, digits), figure(there, unit, digits), difference)
