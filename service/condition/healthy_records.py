"""The standing asymmetry of a motor, learnt from the files of its healthy recordings, in a worker process."""

from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING

from core.diagnosis.errors import DiagnosisError
from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.recordings import Recording, RecordingError, read
from service.recording_store.recording import Source

if TYPE_CHECKING:
    from core.diagnosis.baseline import Baseline

MOST_VALUES = 8_000_000
"""A longer recording is rejected: it would take more memory than a worker may have.

Twenty channels at 10 kHz have half a minute."""


@lru_cache(maxsize=64)
def learnt(healthy: tuple[Source, ...], motor: Motor) -> "Baseline":
    """Return the baseline of healthy recordings. Raises DiagnosisError, RecordingStoreError, OSError.

    Stored files never change, so what was learnt from them once holds as long as this worker lives.
    """
    from core.diagnosis.stator import learn_baseline

    try:
        return learn_baseline(_read(healthy, motor), motor)
    except (RecordingError, DiagnosisError) as error:
        raise DiagnosisError(f"the motor's baseline cannot be learnt: {error}") from error


def _read(healthy: tuple[Source, ...], motor: Motor) -> Iterator[Recording]:
    for one in healthy:
        with one.opened() as entry:
            yield read(entry, lenient=motor.reads_leniently, most_values=MOST_VALUES, layout=layout_of(motor))
