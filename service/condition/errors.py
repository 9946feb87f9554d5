"""What goes wrong where conditions are folded."""


class RecordFoldError(Exception):
    """The fold of one record failed, which none should: its motor's condition cannot go on beyond it."""

    def __init__(self, recording_id: str, reason: str) -> None:
        super().__init__(recording_id, reason)
        self.recording_id = recording_id
        self.reason = reason
