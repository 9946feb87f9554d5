"""Samples of recordings, binary and as CSV, and what follows from them."""

from cmath import phase
from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass
from math import degrees
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Depends, Query, Response
from fastapi.responses import StreamingResponse

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import ApiContext, Context
from service.api.exports.answers import sent_file
from service.api.problems import problems
from service.api.recordings.archive import file_stem
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.api.samples.opening import in_turn, of_recording
from service.api.samples.schemas import (
    MOST_POINTS,
    Phasor,
    Phasors,
    SpectralLine,
    Spectrum,
    States,
    StateTimeline,
)
from service.api.times import rfc3339
from service.storage.records import RecordingEntry
from service.waveforms.csv_samples import csv_samples
from service.waveforms.modelled import modelled_window
from service.waveforms.opened import Opened
from service.waveforms.phasors import NamedPhasor, PhasorsAt, phasors_at
from service.waveforms.recorded import begin_ns
from service.waveforms.spectra import CurrentSpectrum, spectrum_of
from service.waveforms.states import timelines
from service.waveforms.windows import encoded, window_of

router = APIRouter(prefix="/recordings/{recording_id}", tags=["recordings"])

BINARY = "application/octet-stream"
_BINARY: dict[int | str, dict[str, Any]] = {
    **problems(404, 409),
    200: {"content": {BINARY: {"schema": {"type": "string", "format": "binary"}}}},
}
_CSV: dict[int | str, dict[str, Any]] = {
    **problems(404, 409),
    200: {"content": {"text/csv": {"schema": {"type": "string", "format": "binary"}}}},
}
FARTHEST_S = 1e6

Seconds = Annotated[
    float | None, Query(ge=-FARTHEST_S, le=FARTHEST_S, description="Seconds after the first sample.")
]
Points = Annotated[int, Query(ge=2, le=MOST_POINTS, description="Most values a column.")]


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a recording, from one time to another, and how finely it is wanted."""

    from_s: Seconds = None
    to_s: Seconds = None
    points: Points = 4000


WantedPart = Annotated[Part, Depends()]


@router.get("/samples", response_class=Response, responses=_BINARY, dependencies=[require(Permission.VIEW)])
async def get_samples(
    context: Context,
    recording_id: UUID,
    part: WantedPart,
) -> Response:
    """Return a part of a recording as single-precision numbers: its samples, or extremes where they are more.

    Four bytes have the length of the head (unsigned, little-endian). The head is JSON; then follow the
    columns that it names, each of `count` little-endian single-precision numbers. Times count from `first_s`.
    """

    def seen(entry: RecordingEntry, shown: Opened) -> bytes:
        window = window_of(shown, _within(context, part.points, len(shown.channels)), part.from_s, part.to_s)
        return encoded(window, _about(entry, shown))

    return Response(await of_recording(context, str(recording_id), seen), media_type=BINARY)


@router.get("/model", response_class=Response, responses=_BINARY, dependencies=[require(Permission.VIEW)])
async def get_model(
    context: Context,
    recording_id: UUID,
    part: WantedPart,
) -> Response:
    """Return the currents that the latest diagnosis's fit draws, and what they leave of the measured ones.

    As `samples`: columns of groups `measured`, `modelled` and `residual`, over the part of the recording that
    was compared. `residual_rms_A` of the head is what is left now; the diagnosis has that of its time.
    """

    def drawn() -> bytes:
        entry = context.repository.recording(str(recording_id))
        replayed = context.recorded.replay(entry, context.repository.current_diagnosis(entry.id))
        window = modelled_window(replayed, part.points, part.from_s, part.to_s)
        return encoded(window, {"recording_id": entry.id, "residual_rms_A": replayed.residual_rms_A})

    return Response(await in_turn(context, drawn), media_type=BINARY)


async def _place(context: Context) -> AsyncIterator[None]:
    """Hold a place for a file until it is sent. Raises BusyError."""
    async with context.exports.admitted():
        yield


@router.get(
    "/csv",
    response_class=StreamingResponse,
    responses=_CSV,
    dependencies=[require(Permission.VIEW), Depends(_place)],
)
async def download_csv(context: Context, recording_id: UUID) -> StreamingResponse:
    """Return all samples and states of a recording as CSV, one line an instant.

    `time_s` counts from the first sample. Values are primary ones, with seven digits; what is missing is
    empty. Before a name that a spreadsheet would take for a formula stands an apostrophe.
    """

    def seen(entry: RecordingEntry, shown: Opened) -> tuple[str, Iterator[bytes]]:
        return f"{file_stem(entry)}.csv", csv_samples(shown)

    name, pieces = await of_recording(context, str(recording_id), seen)
    return sent_file(pieces, "text/csv; charset=utf-8", name)


@router.get("/phasors", responses=problems(404, 409), dependencies=[require(Permission.VIEW)])
async def get_phasors(context: Context, recording_id: UUID, at_s: Seconds = 0.0) -> Phasors:
    """Return phasors and symmetrical components of the cycle around a time, or of the nearest whole one."""

    def seen(entry: RecordingEntry, shown: Opened) -> Phasors:
        return _phasors(entry.id, phasors_at(shown, at_s or 0.0))

    return await of_recording(context, str(recording_id), seen)


@router.get("/spectrum", responses=problems(404, 409), dependencies=[require(Permission.VIEW)])
async def get_spectrum(context: Context, recording_id: UUID, points: Points = 2000) -> Spectrum:
    """Return the spectrum of the line currents, with the lines that matter for the motor."""
    stored = context.repository.current_diagnosis(str(recording_id))
    diagnosis = None if stored is None else Diagnosis.model_validate(stored.document)
    speed, slip = (None, None) if diagnosis is None else (diagnosis.speed_rpm, diagnosis.rotor_slip)

    def seen(entry: RecordingEntry, shown: Opened) -> Spectrum:
        return _spectrum(entry.id, spectrum_of(shown, points, speed_rpm=speed, slip=slip))

    return await of_recording(context, str(recording_id), seen)


@router.get("/states", responses=problems(404, 409), dependencies=[require(Permission.VIEW)])
async def get_states(context: Context, recording_id: UUID) -> States:
    """Return the states recorded beside the samples: contacts, relay word bits."""

    def seen(entry: RecordingEntry, shown: Opened) -> States:
        found = [StateTimeline.model_validate(one) for one in timelines(shown)]
        return States(recording_id=entry.id, duration_s=shown.recording.duration_s, states=found)

    return await of_recording(context, str(recording_id), seen)


def _within(context: ApiContext, points: int, channels: int) -> int:
    return min(points, max(2, context.settings.max_waveform_values // max(1, channels)))


def _about(entry: RecordingEntry, shown: Opened) -> dict[str, object]:
    begin = begin_ns(entry, shown)
    return {
        "recording_id": entry.id,
        "start_time": None if begin is None else rfc3339(begin),
        "trigger_s": shown.trigger_s,
        "sample_rate_hz": shown.recording.sample_rate_hz,
        "recording_samples": shown.samples,
    }


def _phasor(one: NamedPhasor) -> Phasor:
    return Phasor(name=one.name, magnitude=abs(one.value), angle_deg=degrees(phase(one.value)), unit=one.unit)


def _phasors(recording_id: str, found: PhasorsAt) -> Phasors:
    return Phasors(
        recording_id=recording_id,
        at_s=found.at_s,
        frequency_hz=found.frequency_hz,
        frequency_is_assumed=found.is_assumed,
        sequence=found.sequence,
        reference=found.reference,
        phases=[_phasor(one) for one in found.phases],
        components=[_phasor(one) for one in found.components],
        voltage_unbalance=found.ratio("V2", "V1"),
        current_unbalance=found.ratio("I2", "I1"),
        active_power_W=found.active_power_W,
        power_factor=found.power_factor,
    )


def _spectrum(recording_id: str, found: CurrentSpectrum) -> Spectrum:
    a, b, c = (row.tolist() for row in found.level_dB)
    return Spectrum(
        recording_id=recording_id,
        first_s=found.first_s,
        last_s=found.last_s,
        supply_hz=found.supply_hz,
        resolution_hz=found.resolution_hz,
        slip=found.slip,
        seconds_for_sidebands=found.seconds_for_sidebands,
        frequency_hz=found.frequency_hz.tolist(),
        a_dB=a,
        b_dB=b,
        c_dB=c,
        lines=[
            SpectralLine(
                label=one.line.label,
                meaning=one.line.meaning,
                frequency_hz=one.line.frequency_hz,
                amplitude_A=one.amplitude_A,
                level_dB=one.level_dB,
            )
            for one in found.lines
        ],
    )
