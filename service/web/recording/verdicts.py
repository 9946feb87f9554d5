"""What a diagnosis says, as a sentence and a state that pages have an icon for."""

from typing import Final

from core.diagnosis.verdict import Verdict
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.storage.records import RecordingEntry
from service.storage.states import RecordingState
from service.web.words import interval, percent

LOOKS: Final = {
    Verdict.HEALTHY: "healthy",
    Verdict.WATCH: "watch",
    Verdict.FAULT: "fault",
    Verdict.UNDIAGNOSABLE: "unknown",
}
WORDS: Final = {Verdict.UNDIAGNOSABLE: "not diagnosed"}
"""Where people say it in other words than programs."""

WAITING: Final = {
    RecordingState.ANNOUNCED: "The relay has it; its files are still to be pulled.",
    RecordingState.FETCHED: "It waits for its diagnosis.",
}


def look_of(verdict: Verdict | None) -> str:
    """Return the state whose icon and colour a verdict has."""
    return "unknown" if verdict is None else LOOKS[verdict]


def words_of(verdict: Verdict | None) -> str:
    """Return a verdict in words."""
    return "no diagnosis yet" if verdict is None else WORDS.get(verdict, str(verdict))


def sentence(recording: RecordingEntry, diagnosis: Diagnosis | None) -> str:
    """Return what the recording says by itself, in one sentence or two."""
    if diagnosis is None:
        reason = f" {recording.reason}" if recording.reason else ""
        return WAITING.get(recording.state, f"The recording is {recording.state}.") + reason
    first = diagnosis.reasons[0] if diagnosis.reasons else ""
    level = f"{percent(diagnosis.mu_f)} of its turns (95 % interval {interval(diagnosis.mu_f_ci95)})"
    if diagnosis.phase is not None:
        found = "Shorted turns" if diagnosis.verdict is Verdict.FAULT else "Signs of shorted turns"
        return f"{found} in phase {diagnosis.phase}: {level}."
    if diagnosis.verdict is Verdict.HEALTHY:
        if diagnosis.detection_limit is None:
            return "No shorted turns are found."
        limit = percent(diagnosis.detection_limit)
        return f"No shorted turns are found. Nine of ten such recordings show a fault of {limit}."
    return first[:1].upper() + first[1:] if first else words_of(diagnosis.verdict)
