"""A diagnosis drawn again: the currents that its fitted parameters make of the recorded voltages."""

from dataclasses import dataclass

import numpy as np

from core.diagnosis.acceptance import accept
from core.diagnosis.baseline import Baseline
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.residual import residual_rms_A
from core.diagnosis.stator import candidate_of
from core.diagnosis.verdict import FittedParameters
from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.playback import Playback
from core.machines.stator_models import MODELS
from core.machines.winding_frame import line_currents
from core.recordings import Recording


@dataclass(frozen=True, slots=True)
class Replay:
    """Measured and modelled line currents over the part of a recording that was compared.

    Parameters
    ----------
    first_s : float
        Time of the first sample after the first one of the recording [s].
    sample_rate_hz : float
        Sampling rate [Hz].
    measured_abc, modelled_abc : ndarray, shape (3, n)
        Line currents of terminals a, b, c [A]. The model knows no zero sequence. Where a standing asymmetry
        was taken off the measured currents before the diagnosis, the modelled ones have it.
    residual_rms_A : float
        Their distance over both Clarke axes, rms, as the diagnosis tells it [A].
    """

    first_s: float
    sample_rate_hz: float
    measured_abc: Array
    modelled_abc: Array
    residual_rms_A: float


def replay(
    recording: Recording,
    motor: Motor,
    fit: FittedParameters,
    *,
    model: str,
    baseline: Baseline | None = None,
    currents_only: bool = False,
) -> Replay:
    """Draw the currents of a diagnosis again.

    Parameters
    ----------
    recording : Recording
        The recording that was diagnosed.
    motor : Motor
        The motor as it was diagnosed.
    fit : FittedParameters
        What the diagnosis fitted.
    model : str
        Fault model that it used.
    baseline : Baseline or None, optional
        Standing asymmetry that was taken off.
    currents_only : bool, default False
        Whether the recorded voltages were not used.

    Returns
    -------
    Replay
        The currents.

    Raises
    ------
    RecordingError
        If the recording lacks channels that the motor needs.
    DiagnosisError
        If the model is unknown, the quality gate refuses the recording, or the parameters give no currents.
    """
    if model not in MODELS:
        raise DiagnosisError(f"model {model!r} is unknown; known: {', '.join(MODELS)}")
    accepted = accept(recording, motor, currents_only=currents_only).accepted
    if accepted is None:
        raise DiagnosisError("the quality gate refuses the recording: no current was modelled")
    case = accepted.case
    compared = case if baseline is None else baseline.taken_off(case)
    try:
        playback = Playback(MODELS[model], motor, compared.supply, compared.window)
        modelled_ab = playback.trajectories(candidate_of(compared, fit)).current[0]
    except (ValueError, ArithmeticError, np.linalg.LinAlgError) as error:
        raise DiagnosisError(f"the parameters of the diagnosis give no currents: {error}") from error
    if not np.isfinite(modelled_ab).all():
        raise DiagnosisError("the parameters of the diagnosis give no finite currents")
    window = slice(case.window.first, case.window.last)
    standing_ab = (case.current_ab - compared.current_ab)[:, window]
    lines = line_currents(modelled_ab + standing_ab, case.sequence, motor.nameplate.connection)
    before = recording.samples.shape[1] - accepted.terminals.current_abc.shape[1]
    return Replay(
        first_s=(before + case.window.first) / case.sample_rate_hz,
        sample_rate_hz=case.sample_rate_hz,
        measured_abc=accepted.terminals.current_abc[:, window],
        modelled_abc=lines,
        residual_rms_A=residual_rms_A(compared, modelled_ab),
    )
