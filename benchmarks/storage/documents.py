"""Documents of diagnoses and conditions as large as real ones: some thirty findings of the quality gate."""

import json
from collections.abc import Mapping
from dataclasses import replace

from core.quality.finding import QualityFinding
from testing.service.conditions import FAULT
from testing.service.plants import fault

FINDINGS = 33

_MU_F = 0.0123456789
_FINDING = QualityFinding("held samples IA", 3.2e-4, 0.045, "of one phase", passed=True, message="")
_REASON = (
    "backward-turning current that the supply does not cause is 26.68 % of the forward one; sensors and "
    "parameters within their tolerances can feign 4.71 % of it"
)
_DOCUMENT = replace(fault(_MU_F), quality=(_FINDING,) * FINDINGS, reasons=(_REASON,) * 3).as_dict()
_TEXT = json.dumps(_DOCUMENT)


def document(mu_f: float) -> str:
    """Return the JSON text of a diagnosis with this fault level."""
    return _TEXT.replace(str(_MU_F), f"{mu_f:.7f}")


def condition_document() -> Mapping[str, object]:
    """Return the document of a condition."""
    return FAULT.as_dict()
