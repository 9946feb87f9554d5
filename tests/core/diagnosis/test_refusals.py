"""Recordings with one thing wrong are refused, by the name of the check that they fail."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.recordings import Recording
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running


def healthy_record() -> Recording:
    return recording(running(REFERENCE, 0.5), noise=0.005)


def spoilt(kind: str) -> Recording:  # noqa: C901 - one case a check
    """A healthy recording with one thing wrong."""
    record = healthy_record()
    x, channels = record.samples.copy(), list(record.channels)
    match kind:
        case "missing samples":
            x[1, 300] = np.nan
        case "duration":
            x = x[:, :900]
        case "clipping IA":
            x[0] = np.clip(x[0], -1.0, 1.0)
            channels[0] = replace(channels[0], full_scale=1.0)
        case "held samples IB":
            x[1] = np.repeat(x[1, ::100], 100)
        case "frequency":
            t = np.arange(6000) / 10_000.0
            x = np.sqrt(2) * np.cos(2 * np.pi * 35.0 * t - np.array([[0, 2, 4, 0, 2, 4]]).T * np.pi / 3)
            x[3:] *= 220
        case "voltage":
            x[3:] *= 0.1
        case "current":
            x[:3] *= 0.001
        case "phase order":
            x[[1, 2]] = x[[2, 1]]
        case "phase loss":
            x[2] *= 0.02
        case "current sum":
            x[2] *= 0.4
        case "polarity":
            x[:3] *= -1
        case "steadiness":
            x[:3] *= np.linspace(1.0, 1.6, x.shape[1])
    return replace(record, samples=x, channels=tuple(channels))


@pytest.mark.parametrize(
    "check",
    [
        "missing samples", "duration", "clipping IA", "held samples IB", "frequency", "voltage", "current",
        "phase order", "phase loss",
        "current sum", "polarity", "steadiness",
    ],
)  # fmt: skip
def test_the_gate_refuses_with_name_figure_and_reason(check: str) -> None:
    result = diagnose(spoilt(check), REFERENCE)
    assert result.verdict is Verdict.UNDIAGNOSABLE
    assert result.mu_f is None
    assert result.evaluations == 0
    failed = [finding for finding in result.quality if not finding.passed]
    assert check in [finding.name for finding in failed]
    assert all(finding.message for finding in failed)
    assert any(reason.startswith(check) for reason in result.reasons)


def test_silence_is_undiagnosable() -> None:
    record = healthy_record()
    result = diagnose(replace(record, samples=np.zeros_like(record.samples)), REFERENCE)
    assert result.verdict is Verdict.UNDIAGNOSABLE
