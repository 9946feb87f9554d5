"""The error of the readers of relay reports: which report, which line, what was expected."""


class ReportError(ValueError):
    """The error of a report that cannot be read as it is; nothing of it was guessed.

    Parameters
    ----------
    report : str
        Name of the report: its file, or what the caller calls it.
    place : str
        Place in it, such as "line 12, IA".
    expected, found : str
        What was expected and what was found, in words.
    """

    def __init__(self, report: str, place: str, *, expected: str, found: str) -> None:
        self.report = report
        self.place = place
        self.expected = expected
        self.found = found
        super().__init__(f"{report}: {place}: expected {expected}, found {found}")

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (self.report, self.place, self.expected, self.found)


def _rebuild(report: str, place: str, expected: str, found: str) -> ReportError:
    return ReportError(report, place, expected=expected, found=found)
