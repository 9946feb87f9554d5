"""Read recordings that a command is given, and tell what to do where one cannot be used as it is."""

from pathlib import Path

from core.error_words import one_line
from core.recordings import Recording, RecordingError, read
from core.recordings.reading import mended_by
from core.table_layout import ANY_LAYOUT, TableLayout
from service.cli.output import CommandError


def read_recording(
    path: Path, *, lenient: bool, layout: TableLayout = ANY_LAYOUT, report: int | None = None
) -> Recording:
    """Read a recording. layout: what is known of the columns of a table.

    `report` chooses one of a capture with several event reports.

    Raises RecordingError, or CommandError that names --lenient where that would read the recording.
    """
    try:
        return read(path, lenient=lenient, layout=layout, report=report)
    except RecordingError as error:
        mended = None if lenient else mended_by(path, report)
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
