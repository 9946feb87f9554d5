"""The standing asymmetry of a motor, learnt from the files of its healthy recordings, in a worker process."""

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from core.diagnosis.errors import DiagnosisError
from core.machines.parameters import Motor
from core.recordings import RecordingError, read

if TYPE_CHECKING:
    from core.diagnosis.baseline import Baseline

MOST_VALUES = 8_000_000
"""A longer recording is rejected: it would take more memory than a worker may have.

Twenty channels at 10 kHz have half a minute."""


@lru_cache(maxsize=64)
def learnt(healthy: tuple[Path, ...], motor: Motor) -> "Baseline":
    """Return the baseline learnt from healthy recordings. Raises DiagnosisError.

    Stored files never change, so what was learnt from them once holds as long as this worker lives.
    """
    from core.diagnosis.stator import learn_baseline

    try:
        return learn_baseline((read(one, most_values=MOST_VALUES) for one in healthy), motor)
    except (RecordingError, DiagnosisError) as error:
        raise DiagnosisError(f"the motor's baseline cannot be learnt: {error}") from error
