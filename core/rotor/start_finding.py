"""What a start tells of the rotor's cage, and whether the running motor says the same."""

from dataclasses import dataclass
from math import inf

from core.rotor.finding import RotorFinding, RotorState


@dataclass(frozen=True, slots=True)
class StartSideband:
    """What a start tells of the rotor's cage; figures are None where it cannot tell them.

    Parameters
    ----------
    state : RotorState
        Healthy, watch, fault, or unsupported.
    severity_dB : float or None
        Asymmetry of the rotor's resistance, half the difference of its axes over its value [dB]; as of
        `RotorFinding`.
    severity_dB_ci95 : tuple of float or None
        Its 95 % interval; the lower end is None where the interval reaches down to no asymmetry.
    detection_limit_dB : float or None
        Severity from which on such a start shows an asymmetry [dB].
    stretches : int
        Stretches of the run-up in which the path was followed.
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: tuple[float | None, float] | None
    detection_limit_dB: float | None
    stretches: int
    reasons: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the finding as JSON takes it.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        interval = self.severity_dB_ci95
        return {
            "state": str(self.state),
            "severity_dB": self.severity_dB,
            "severity_dB_ci95": None if interval is None else list(interval),
            "detection_limit_dB": self.detection_limit_dB,
            "stretches": self.stretches,
            "reasons": list(self.reasons),
        }


def agreement(running: RotorFinding, start: StartSideband) -> tuple[bool | None, str]:
    """Compare what a running motor shows of its cage with what its start shows.

    Parameters
    ----------
    running : RotorFinding
        Of a record of the running motor.
    start : StartSideband
        Of a start.

    Returns
    -------
    agrees : bool or None
        Whether both say the same; None where one of them cannot tell.
    words : str
        The comparison in words.
    """
    if RotorState.UNSUPPORTED in (running.state, start.state):
        which = "the running record" if running.state is RotorState.UNSUPPORTED else "the start"
        return None, f"{which} cannot tell of the rotor"
    told = [
        f"{name} says {one.state}"
        + ("" if one.severity_dB is None else f" ({one.severity_dB:.0f} dB)")
        + ("" if one.detection_limit_dB is None else f", shows {one.detection_limit_dB:.0f} dB and more")
        for name, one in (("running, it", running), ("the start", start))
    ]
    words = "; ".join(told)
    ill = [one.state is not RotorState.HEALTHY for one in (running, start)]
    if ill[0] == ill[1]:
        return True, f"both agree: {words}"
    found, other = (running, start) if ill[0] else (start, running)
    if found.severity_dB is not None and found.severity_dB < (other.detection_limit_dB or -inf):
        return None, f"too small for one of them: {words}"
    return False, f"they do not agree: {words}. Record another start, and the motor running under load"
