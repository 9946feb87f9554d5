"""Findings of the quality checks."""

from dataclasses import dataclass

from core.operation import Operation

GREATEST_FIGURE = 1e30
"""Greatest figure of a finding. Greater ones are cut to it, because JSON has no infinity."""


@dataclass(frozen=True, slots=True)
class QualityFinding:
    """One check of the quality gate.

    A finding that passed and has a message is a warning.

    Parameters
    ----------
    name : str
        Name of the check.
    value : float
        Figure that it measured.
    limit : float
        Limit of the figure.
    unit : str
        Unit of both.
    passed : bool
        Whether the check passed.
    message : str
        What a failure means, and what to do; or a warning.
    operation : Operation or None, optional
        What the motor does, where the check failed for that; None where something is wrong with the record.
    """

    name: str
    value: float
    limit: float
    unit: str
    passed: bool
    message: str
    operation: Operation | None = None

    @property
    def is_warning(self) -> bool:
        """Whether the check passed and there is something to tell all the same."""
        return self.passed and bool(self.message)

    def as_dict(self) -> dict[str, str | float | bool]:
        """Return the finding as JSON takes it.

        Returns
        -------
        dict of str to str
            The fields by name.
        """
        return {
            "name": self.name,
            "value": self.value,
            "limit": self.limit,
            "unit": self.unit,
            "passed": self.passed,
            "message": self.message,
        }


def finding(
    name: str,
    value: float,
    limit: float,
    unit: str,
    *,
    passed: bool,
    message: str,
    operation: Operation | None = None,
) -> QualityFinding:
    """Make the result of a check; the message is only said where it failed.

    Parameters
    ----------
    name : str
        Name of the check.
    value : float
        Figure that it measured.
    limit : float
        Limit of the figure.
    unit : str
        Unit of both.
    passed : bool
        Whether the check passed.
    message : str
        What a failure means, and what to do.
    operation : Operation or None, optional
        What the motor does, where that is why the check fails.

    Returns
    -------
    QualityFinding
        The finding.
    """
    shown = min(max(float(value), -GREATEST_FIGURE), GREATEST_FIGURE)
    return QualityFinding(
        name,
        shown,
        float(limit),
        unit,
        bool(passed),
        "" if passed else message,
        None if passed else operation,
    )


def file_warning(message: str) -> QualityFinding:
    """Return the finding of a file that departs from its standard without a change of any value.

    Parameters
    ----------
    message : str
        What was found, and how it is read.

    Returns
    -------
    QualityFinding
        The warning.
    """
    return QualityFinding("file", 1.0, 1.0, "departure from the standard", passed=True, message=message)


def all_passed(findings: list[QualityFinding]) -> bool:
    """Return whether all checks passed.

    Parameters
    ----------
    findings : list of QualityFinding
        The findings.

    Returns
    -------
    bool
        Whether none failed.
    """
    return all(one.passed for one in findings)


def file_repair(message: str) -> QualityFinding:
    """Return what a lenient reader mended in a recording's file, as a finding.

    Parameters
    ----------
    message : str
        What was at fault, and what was done about it.

    Returns
    -------
    QualityFinding
        The warning.
    """
    return file_warning(f"repaired: {message}")
