"""Errors of the commissioning."""


class CommissioningError(ValueError):
    """A recording is no start from which parameters can be told: which one, what of it, what was expected."""

    def __init__(self, source: str, field: str, *, expected: str, found: str) -> None:
        self.source = source
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{source}: {field}: expected {expected}, found {found}")
