"""Read recordings that a command is given, and tell what to do where one cannot be used as it is."""

from pathlib import Path

from core.error_words import one_line
from core.recordings import Recording, RecordingError, read
from core.recordings.reading import mended_by
from service.cli.output import CommandError


def read_recording(path: Path, *, lenient: bool) -> Recording:
    """Read a recording.

    Raises RecordingError, or CommandError that names --lenient where that would read the recording.
    """
    try:
        return read(path, lenient=lenient)
    except RecordingError as error:
        mended = None if lenient else mended_by(path)
        if mended is None:
            raise
        advice = f"--lenient reads it all the same, and says what it mends: {mended}"
        raise with_advice(error, advice) from error


def with_advice(error: RecordingError, advice: str) -> CommandError:
    """Return the failure, and what to do about it."""
    failure = CommandError.from_error(error)
    return CommandError(
        f"{failure}; {one_line(advice)}", details=failure.details, exit_code=failure.exit_code
    )
