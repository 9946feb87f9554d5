"""Errors of the commissioning."""


class CommissioningError(ValueError):
    """The error of a recording that is no start from which parameters can be told.

    Parameters
    ----------
    source : str
        Name of the recording.
    field : str
        What of it is at fault.
    expected : str
        What was expected, in words.
    found : str
        What was found, in words.
    """

    def __init__(self, source: str, field: str, *, expected: str, found: str) -> None:
        self.source = source
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{source}: {field}: expected {expected}, found {found}")


class DivergenceError(CommissioningError):
    """The error of starts that the motor's model cannot follow: its current grows without bound.

    Parameters
    ----------
    sources : str
        Names of the recordings.
    """

    def __init__(self, sources: str) -> None:
        super().__init__(
            sources,
            "start",
            expected="a start that a motor of this nameplate can make",
            found="one for which the model's current grows without bound, where it comes nearest",
        )
