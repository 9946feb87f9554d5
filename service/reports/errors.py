"""Errors of reports."""


class ReportError(RuntimeError):
    """A report could not be made; it says why."""


class ReportRequestError(ValueError):
    """No such report can be made. parameter: which one is wrong."""

    def __init__(self, parameter: str, problem: str) -> None:
        super().__init__(f"{parameter}: {problem}")
        self.parameter = parameter
        self.problem = problem
