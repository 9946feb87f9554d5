"""What the model leaves of the currents of a recording, drawn anew by a worker."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Final

from service.api.context import ApiContext
from service.api.problems import ProblemError
from service.api.samples.opening import in_words
from service.storage.records import RecordingEntry
from service.web.charts import Chart
from service.web.recording.waveform_charts import residual_chart

SAME: Final = 1e-3
"""Residuals that differ by a smaller share are the same but for the last digits."""


@dataclass(frozen=True, slots=True)
class DrawnModel:
    """What is left now and what the diagnosis told [A]; `problem` where nothing could be drawn."""

    first_s: float = 0.0
    left_A: float | None = None
    told_A: float | None = None
    chart: Chart | None = None
    problem: str = ""

    @property
    def differs(self) -> bool:
        """Tell whether the motor's parameters or its baseline must have changed since the diagnosis."""
        if self.left_A is None or self.told_A is None:
            return False
        return abs(self.left_A - self.told_A) > SAME * max(abs(self.told_A), 1e-9)


def drawn_model(context: ApiContext, entry: RecordingEntry) -> DrawnModel:
    """Have the model's currents drawn. Raises ProblemError where no worker is there at present."""
    stored = context.repository.current_diagnosis(entry.id)
    try:
        replayed = in_words(lambda: context.recorded.replay(entry, stored))
    except ProblemError as error:
        if error.status is HTTPStatus.SERVICE_UNAVAILABLE:
            raise
        return DrawnModel(problem=error.detail)
    told = None if stored is None else stored.document.get("residual_rms_A")
    return DrawnModel(
        first_s=replayed.first_s,
        left_A=replayed.residual_rms_A,
        told_A=float(told) if isinstance(told, int | float) else None,
        chart=residual_chart(replayed),
    )
