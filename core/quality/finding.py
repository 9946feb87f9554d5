"""How a check says what it found."""

from dataclasses import dataclass

HUGE = 1e30
"""Figures beyond it are shown as it: a document has no infinity."""


@dataclass(frozen=True, slots=True)
class QualityFinding:
    """One check of the quality gate: its name, the figure it measured, its limit and what that means."""

    name: str
    value: float
    limit: float
    unit: str
    passed: bool
    message: str

    def as_dict(self) -> dict[str, str | float | bool]:
        return {
            "name": self.name,
            "value": self.value,
            "limit": self.limit,
            "unit": self.unit,
            "passed": self.passed,
            "message": self.message,
        }


def finding(
    name: str, value: float, limit: float, unit: str, *, passed: bool, message: str
) -> QualityFinding:
    """A check's result; the message is only said where it failed."""
    shown = min(max(float(value), -HUGE), HUGE)
    return QualityFinding(name, shown, float(limit), unit, bool(passed), "" if passed else message)


def all_passed(findings: list[QualityFinding]) -> bool:
    return all(one.passed for one in findings)
