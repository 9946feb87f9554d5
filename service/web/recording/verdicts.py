"""What a diagnosis says, as a sentence and a state that pages have an icon for."""

from typing import Final

from core.condition.kinds import State
from core.diagnosis.phase_words import turns_phase_in_words
from core.diagnosis.verdict import Verdict
from core.motor_condition.parts import RANKS
from core.rotor.finding import RotorState
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

ROTORS: Final = {
    RotorState.FAULT: "The rotor is as uneven as broken bars or rings make it.",
    RotorState.WATCH: "The rotor is uneven.",
}
"""What a record says of a rotor that somebody has to look after."""

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


def page_look(diagnosis: Diagnosis | None) -> str:
    """Return the look of the worse one of what a record shows of the winding and of the rotor."""
    if diagnosis is None:
        return look_of(None)
    looks = [State(look_of(diagnosis.verdict))]
    if diagnosis.rotor is not None and diagnosis.rotor.state in ROTORS:
        looks.append(State(diagnosis.rotor.state))
    return min(looks, key=RANKS.__getitem__)


def page_words(diagnosis: Diagnosis | None) -> str:
    """Return the words beside that look: the verdict's, where the rotor is no worse."""
    verdict, look = None if diagnosis is None else diagnosis.verdict, page_look(diagnosis)
    return words_of(verdict) if look == look_of(verdict) else look


def sentence(recording: RecordingEntry, diagnosis: Diagnosis | None) -> str:
    """Return what the recording says by itself, in a few sentences."""
    if diagnosis is None:
        reason = f" {recording.reason}" if recording.reason else ""
        return WAITING.get(recording.state, f"The recording is {recording.state}.") + reason
    rotor = None if diagnosis.rotor is None else ROTORS.get(diagnosis.rotor.state)
    of_winding = _of_winding(diagnosis)
    return of_winding if rotor is None else f"{rotor} {of_winding}"


def _of_winding(diagnosis: Diagnosis) -> str:
    first = diagnosis.reasons[0] if diagnosis.reasons else ""
    phase = turns_phase_in_words(diagnosis.model_dump())
    if phase is not None:
        found = "Shorted turns" if diagnosis.verdict is Verdict.FAULT else "Signs of shorted turns"
        where = f" in phase {phase}" if phase else ""
        level = f"{percent(diagnosis.mu_f)} of the phase's turns"
        return f"{found}{where}: {level} (95 % interval {interval(diagnosis.mu_f_ci95)})."
    if diagnosis.verdict is Verdict.HEALTHY:
        if diagnosis.detection_limit is None:
            return "No shorted turns are found."
        limit = percent(diagnosis.detection_limit)
        return f"No shorted turns are found. Nine of ten such recordings show a fault of {limit}."
    return first[:1].upper() + first[1:] if first else words_of(diagnosis.verdict)
