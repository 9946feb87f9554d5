"""The demo's diagnoses beside the truth, as a table for people and a document for programs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.diagnosis.phase_words import turns_phase_in_words
from core.quantity_text import plain
from service.client.rest_client import Document
from service.client.tables import FittedTable
from service.client.verdicts import interval, load, percent, verdict_text
from service.demo.truth import Truth

FOOTNOTE = "interval: from all causes; see docs/explanation/diagnosis.md"


@dataclass(frozen=True, slots=True)
class DemoDiagnosis:
    """The diagnosis of one requested recording (as `mcc diagnose --json`), or why there is none."""

    document: Document | None
    seconds: float | None
    reason: str | None = None

    def as_dict(self) -> dict[str, object]:
        if self.document is None:
            return {"error": {"message": self.reason}}
        return {**self.document, "trigger_to_diagnosis_seconds": self.seconds}


@dataclass(frozen=True, slots=True)
class DemoMotor:
    """One motor of the demo plant with its diagnoses."""

    name: str
    site: str
    truth: Truth
    ied: str = ""
    diagnoses: list[DemoDiagnosis] = field(default_factory=list)

    def as_dict(self) -> dict[str, object]:
        return {
            "motor": self.name,
            "site": self.site,
            "truth": self.truth.as_dict(),
            "diagnoses": [diagnosis.as_dict() for diagnosis in self.diagnoses],
        }


def document(
    motors: Sequence[DemoMotor], seconds: float, conditions: Mapping[str, Document] | None = None
) -> dict[str, object]:
    """Return the document that `mcc demo --json FILE` writes.

    conditions: by motor, where they are part of it.
    """
    shown = [motor.as_dict() for motor in motors]
    for motor in shown if conditions is not None else ():
        motor["condition"] = (conditions or {})[str(motor["motor"])]
    return {"seconds": round(seconds, 3), "motors": shown}


def slowest(motors: Sequence[DemoMotor]) -> float | None:
    """Return the longest time from a trigger to the stored diagnosis [s], the relay's recording included."""
    times = [diagnosis.seconds for motor in motors for diagnosis in motor.diagnoses]
    return max((seconds for seconds in times if seconds is not None), default=None)


def table(motors: Sequence[DemoMotor]) -> FittedTable:
    """Return a table of every motor's diagnoses beside its truth."""
    shown = FittedTable(
        title="Diagnoses and truth",
        title_justify="left",
        caption=FOOTNOTE,
        caption_justify="left",
        box=SIMPLE_HEAD,
        collapse_padding=True,
    )
    shown.add_column("motor", no_wrap=True)
    for heading in ("truth", "verdict"):
        shown.add_column(heading)  # these wrap on a narrow terminal, so that the figures stay whole
    for heading in ("mu_f %", "95 %\ninterval", "detection\nlimit %", "load", "trigger to\ndiagnosis s"):
        shown.add_column(heading, justify="right", no_wrap=True)
    for motor in motors:
        for number, diagnosis in enumerate(motor.diagnoses):
            first = number == 0
            shown.add_row(
                Text(motor.name if first else ""),
                truth_text(motor.truth) if first else "",
                *_row(diagnosis),
            )
    return shown


def truth_text(truth: Truth) -> str:
    """Return the truth in words: "5 % b, load 0.65"."""
    return f"{condition_text(truth)}, load {plain(truth.load_level)}"


def condition_text(truth: Truth) -> str:
    """Return what is to be known of the motor and its channels: "5 % b", "healthy, VB -0.4 %"."""
    words = ["healthy" if truth.phase is None else f"{plain(100 * truth.mu_f)} % {truth.phase}"]
    words += [] if truth.running else ["stands still"]
    words += [f"{plain(truth.broken_bars)} of {truth.bars} bars broken"] if truth.broken_bars else []
    words += ["load pulsates"] if truth.pulsations else []
    words += [f"{name} {100 * channel.gain:+.2g} %" for name, channel in truth.channels.items()]
    return ", ".join(words)


def _row(diagnosis: DemoDiagnosis) -> tuple[str | Text, ...]:
    found = diagnosis.document
    if found is None:
        return Text(diagnosis.reason or "failed", style="red"), "", "", "", "", ""
    return (
        verdict_text(str(found["verdict"]), turns_phase_in_words(found)),
        percent(found["mu_f"]),
        interval(found["mu_f_ci95"]),
        percent(found["detection_limit"]),
        load(found["load_level"]),
        "-" if diagnosis.seconds is None else f"{diagnosis.seconds:.2f}",
    )
