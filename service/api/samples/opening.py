"""Recordings read for one answer: few at a time, and errors in words."""

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import TypeVar

from fastapi.concurrency import run_in_threadpool

from core.recordings import RecordingError
from service.api.context import ApiContext
from service.api.problems import ProblemError
from service.storage.records import RecordingEntry
from service.waveforms.computing import NoAnswerError
from service.waveforms.opened import Opened
from service.waveforms.phasors import NoPhasorsError
from service.waveforms.recorded import NoReplayError, NotStoredError
from service.waveforms.spectra import NoSpectrumError

Result = TypeVar("Result")

_CONFLICTS = (NotStoredError, NoReplayError, NoPhasorsError, NoSpectrumError)


@asynccontextmanager
async def _turn(context: ApiContext) -> AsyncIterator[None]:
    async with context.waveforms_sent.admitted(), context.waveforms_read.admitted():
        yield


async def of_recording(
    context: ApiContext, recording_id: str, look: Callable[[RecordingEntry, Opened], Result]
) -> Result:
    """Read a recording and return what is seen in it. Raises NotFoundError, ProblemError, BusyError."""

    def looked() -> Result:
        entry = context.repository.recording(recording_id)
        return in_words(lambda: look(entry, context.recorded.open(entry)))

    async with _turn(context):
        return await run_in_threadpool(looked)


async def in_turn(context: ApiContext, work: Callable[[], Result]) -> Result:
    """Do what takes as long as reading a recording. Raises ProblemError, BusyError, what `work` raises."""
    async with _turn(context):
        return await run_in_threadpool(in_words, work)


def in_words(work: Callable[[], Result]) -> Result:
    """Do the work. Raises ProblemError where the recording cannot tell what was asked."""
    try:
        return work()
    except RecordingError as error:
        raise ProblemError(HTTPStatus.CONFLICT, f"the recording cannot be read: {error}") from error
    except _CONFLICTS as error:
        raise ProblemError(HTTPStatus.CONFLICT, str(error)) from error
    except NoAnswerError as error:
        raise ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, str(error)) from error
