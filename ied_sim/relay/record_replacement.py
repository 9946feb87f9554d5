"""Another record in the place of the one that a client fetches, as where a relay's numbering begins anew."""

from collections import Counter

from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.relay.event_files import EventFiles
from mms import FileOperation, FileRequest


class RecordReplacement:
    """Replaces the latest record when its samples are opened: its configuration came from the one before."""

    def __init__(self, misbehaviour_state: MisbehaviourState, files: EventFiles) -> None:
        self._misbehaviour_state = misbehaviour_state
        self._files = files
        self._made: Counter[str] = Counter()

    def asked_for_file(self, request: FileRequest) -> None:
        """Replace the record whose samples this opens, if that is to happen. Raises OSError."""
        times = self._misbehaviour_state.number(Kind.RECORD_REPLACED)
        if times is None or request.operation is not FileOperation.OPEN or request.path.suffix != ".DAT":
            return
        stem = request.path.stem
        if self._made[stem] < times and self._files.replace_latest(stem):
            self._made[stem] += 1
