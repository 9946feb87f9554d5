"""What goes wrong with a motor's condition."""


class ObservationError(ValueError):
    """An observation whose numbers no record of a running motor has: it is left out, and the rest counts."""
