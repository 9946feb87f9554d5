"""How a check says what it found."""

from core.diagnosis.verdict import QualityFinding

HUGE = 1e30
"""Figures beyond it are shown as it: a document has no infinity."""


def finding(
    name: str, value: float, limit: float, unit: str, *, passed: bool, message: str
) -> QualityFinding:
    """A check's result; the message is only said where it failed."""
    shown = min(max(float(value), -HUGE), HUGE)
    return QualityFinding(name, shown, float(limit), unit, bool(passed), "" if passed else message)


def all_passed(findings: list[QualityFinding]) -> bool:
    return all(one.passed for one in findings)
