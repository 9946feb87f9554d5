"""What the page of one recording shows."""

from cmath import phase as angle
from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees, isfinite
from typing import Final

from markupsafe import Markup

from core.recordings.errors import RecordingError, RecordingTooLongError
from service.api.context import ApiContext
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.client.classification import AnswerShown, answer_shown
from service.pictures.looks import PAGE
from service.pictures.phasors import Phasor, phasor_picture
from service.recording_store.errors import RecordingStoreError
from service.storage.records import DiagnosisEntry, RecordingEntry, RecordingFile
from service.waveforms.opened import Opened
from service.waveforms.phasors import NamedPhasor, NoPhasorsError, PhasorsAt, phasors_at
from service.waveforms.recorded import NotStoredError, begin_ns
from service.waveforms.spectra import CurrentSpectrum, NoSpectrumError, spectrum_of
from service.waveforms.states import StateTimeline, timelines
from service.waveforms.windows import window_of
from service.web.charts import Chart
from service.web.pictures import markup
from service.web.recording.beside_stator import RotorShown, SupplyShown, rotor_shown, supply_shown
from service.web.recording.waveform_charts import (
    INTERVALS,
    SPECTRUM_POINTS,
    spectrum_chart,
    states_chart,
    waveform_charts,
)

MOST_CHOICES: Final = 100
"""Recordings of the motor that one may be compared with at once; the list has all."""


class NotShownError(Exception):
    """The samples of a recording cannot be shown, and why."""


@dataclass(frozen=True, slots=True)
class Cursor:
    """Phasors at the cursor: the figures, and the picture as SVG; `problem` where there are none."""

    at_s: float
    phasors: PhasorsAt | None
    rows: tuple[tuple[str, str, str, str], ...] = ()
    components: tuple[tuple[str, str, str, str], ...] = ()
    picture: Markup | str = ""
    problem: str = ""


@dataclass(frozen=True, slots=True)
class Waveforms:
    """What is seen in the samples. begin_ns: UTC of the first one.  problem: why there is no spectrum."""

    samples: int
    sample_rate_hz: float
    duration_s: float
    trigger_s: float
    begin_ns: int | None
    charts: tuple[Chart, ...]
    states: tuple[StateTimeline, ...]
    states_chart: Chart | None
    cursor: Cursor
    spectrum: CurrentSpectrum | None
    spectrum_chart: Chart | None
    spectrum_problem: str
    remarks: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RecordingPage:
    """One recording. problem: why its samples are not shown.  copies: other files of the event."""

    entry: RecordingEntry
    stored: DiagnosisEntry | None
    diagnosis: Diagnosis | None
    rotor: RotorShown | None
    supply: SupplyShown | None
    answer: AnswerShown | None
    files: Sequence[RecordingFile]
    copies: Sequence[RecordingEntry]
    earlier: str | None
    later: str | None
    waveforms: Waveforms | None
    problem: str


def recording_page(context: ApiContext, recording_id: str, at_s: float | None) -> RecordingPage:
    """Return what the page of a recording shows. Raises NotFoundError."""
    repository = context.repository
    entry = repository.recording(recording_id)
    stored = repository.current_diagnosis(entry.id)
    diagnosis = None if stored is None else Diagnosis.model_validate(stored.document)
    earlier, later = repository.neighbours(entry)
    waveforms, problem = None, ""
    try:
        waveforms = _waveforms(entry, _opened(context, entry), diagnosis, at_s)
    except NotShownError as error:
        problem = str(error)
    return RecordingPage(
        entry=entry,
        stored=stored,
        diagnosis=diagnosis,
        rotor=rotor_shown(diagnosis),
        supply=supply_shown(diagnosis),
        answer=_answer(diagnosis),
        files=repository.recording_files(entry.id),
        copies=repository.copies_of(entry.id),
        earlier=earlier,
        later=later,
        waveforms=waveforms,
        problem=problem,
    )


def _answer(diagnosis: Diagnosis | None) -> AnswerShown | None:
    """Return the answer of a diagnosis; None where it gives none."""
    if diagnosis is None or diagnosis.classification is None:
        return None
    return answer_shown(diagnosis.classification.model_dump())


def cursor_of(context: ApiContext, recording_id: str, at_s: float) -> Cursor:
    """Return the phasors of a recording around a time. Raises NotFoundError."""
    try:
        shown = _opened(context, context.repository.recording(recording_id))
    except NotShownError as error:
        return Cursor(at_s, None, problem=str(error))
    return _cursor_at(shown, at_s)


def _opened(context: ApiContext, entry: RecordingEntry) -> Opened:
    """Return what the files of a recording hold. Raises NotShownError."""
    try:
        return context.recorded.open(entry)
    except RecordingTooLongError as error:
        message = f"The recording is too long to be shown here; download its files. {error}"
        raise NotShownError(message) from error
    except (NotStoredError, RecordingStoreError, RecordingError, OSError) as error:
        raise NotShownError(str(error)) from error


def _cursor_at(shown: Opened, at_s: float) -> Cursor:
    try:
        found = phasors_at(shown, at_s)
    except NoPhasorsError as error:
        return Cursor(at_s, None, problem=str(error))
    arrows = [Phasor(one.name, one.value, one.unit) for one in found.phases]
    title = f"Phasors at {found.at_s:.4f} s"
    return Cursor(
        at_s=found.at_s,
        phasors=found,
        rows=tuple(map(_row, found.phases)),
        components=tuple(map(_row, found.components)),
        picture=markup(phasor_picture(title, arrows, look=PAGE)),
    )


def _waveforms(
    entry: RecordingEntry, shown: Opened, diagnosis: Diagnosis | None, at_s: float | None
) -> Waveforms:
    recording = shown.recording
    window = window_of(shown, INTERVALS)
    states = timelines(shown)
    spectrum, spectrum_problem = None, ""
    try:
        speed, slip = (None, None) if diagnosis is None else (diagnosis.speed_rpm, diagnosis.rotor_slip)
        spectrum = spectrum_of(shown, SPECTRUM_POINTS, speed_rpm=speed, slip=slip)
    except NoSpectrumError as error:
        spectrum_problem = str(error)
    middle = recording.duration_s / 2.0
    return Waveforms(
        samples=shown.samples,
        sample_rate_hz=recording.sample_rate_hz,
        duration_s=recording.duration_s,
        trigger_s=shown.trigger_s,
        begin_ns=begin_ns(entry, shown),
        charts=waveform_charts(window, shown.trigger_s),
        states=states,
        states_chart=states_chart(states, recording.duration_s),
        cursor=_cursor_at(shown, middle if at_s is None or not isfinite(at_s) else at_s),
        spectrum=spectrum,
        spectrum_chart=None if spectrum is None else spectrum_chart(spectrum),
        spectrum_problem=spectrum_problem,
        remarks=(*recording.repairs, *recording.warnings),
    )


def _row(one: NamedPhasor) -> tuple[str, str, str, str]:
    return one.name, f"{abs(one.value):.4g}", one.unit, f"{degrees(angle(one.value)):z.1f}"
