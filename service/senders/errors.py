"""What keeps a message from being sent."""


class SendError(RuntimeError):
    """A message was not sent, or nobody knows whether it was. The text shows no secret.

    is_final: another attempt would fail as well, as the receiver says.
    """

    def __init__(self, reason: str, *, is_final: bool = False) -> None:
        super().__init__(reason)
        self.is_final = is_final
