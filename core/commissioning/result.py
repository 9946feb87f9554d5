"""What a commissioning found, with intervals, and in words what it could not find."""

from dataclasses import dataclass

from core.machines.parameters import MachineParameters, Motor

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Estimate:
    """An estimated or fixed parameter.

    Parameters
    ----------
    value : float
        Its value.
    ci95 : tuple of float or None
        Its 95 % interval, None where it was fixed.
    fixed : str or None, optional
        Why it was fixed, None where it was not.
    """

    value: float
    ci95: Interval | None
    fixed: str | None = None


@dataclass(frozen=True, slots=True)
class LoadChange:
    """How the load changed during a start.

    Parameters
    ----------
    change : Estimate
        By how much, over the rated torque.
    begins_s : float
        From when on after the motor was switched on [s].
    lasts_s : float
        How long [s].
    is_step : bool
        Whether it changed faster than the record shows.
    """

    change: Estimate
    begins_s: float
    lasts_s: float
    is_step: bool


@dataclass(frozen=True, slots=True)
class StartFound:
    """What was found of one start.

    Parameters
    ----------
    record : str
        Name of the recording.
    onset_s : float
        When the motor was switched on, from the record's first sample [s].
    compared_s : tuple of float
        Part of the record that was compared [s].
    load_level : Estimate
        Load torque over rated torque, at the speed with which the motor then runs; before it changed, where
        it did.
    time_offset_s : Estimate
        Delay of the currents against the voltages [s].
    residual_rms_A : float
        Line current that the model leaves, rms [A].
    residual_share : float
        Its share of the measured rms.
    load_change : LoadChange or None, optional
        How the load changed during the start; None where no change is seen.
    """

    record: str
    onset_s: float
    compared_s: Interval
    load_level: Estimate
    time_offset_s: Estimate
    residual_rms_A: float
    residual_share: float
    load_change: LoadChange | None = None


@dataclass(frozen=True, slots=True)
class Commissioning:
    """Result of `commission`.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters, ready to be written.
    parameters : dict of str to Estimate
        Estimates by the names of MachineParameters.
    change : dict of str to Estimate
        By how much the motor changes from a start to running: entries of `deep_bars.DeepBars` and of
        `deep_bars.LeakageSaturation`, whose share is called saturating_share. Empty where it does not.
    starts : tuple of StartFound
        What was found of each start.
    load_law : str
        How the load torque grows with speed.
    condition_number : float
        Condition number of the Jacobian of all unknowns, each of order one.
    reasons : tuple of str
        In words, what was fixed and what to mind.
    warnings : tuple of str
        Why the recording may not be what it is taken for, with what to check.
    evaluations : int
        Number of simulated candidates or evaluated points.
    compute_seconds : float
        Time of the estimation [s].
    """

    motor: Motor
    parameters: dict[str, Estimate]
    change: dict[str, Estimate]
    starts: tuple[StartFound, ...]
    load_law: str
    condition_number: float
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]
    evaluations: int
    compute_seconds: float

    @property
    def identifiable(self) -> bool:
        """Whether any parameter of the motor was told by the records."""
        return any(one.fixed is None for one in self.parameters.values())

    @property
    def fixed(self) -> tuple[str, ...]:
        """Names of the parameters that were not estimated."""
        return tuple(name for name, one in self.parameters.items() if one.fixed is not None)

    @property
    def machine(self) -> MachineParameters:
        """The parameters as the models take them."""
        return self.motor.parameters

    def as_dict(self) -> dict[str, object]:
        """Return the result as JSON takes it.

        Returns
        -------
        dict of str to object
            The document.
        """
        finite = self.condition_number < float("inf")
        return {
            "identifiable": self.identifiable,
            "parameters": {name: _estimate(one) for name, one in self.parameters.items()},
            "change": {name: _estimate(one) for name, one in self.change.items()},
            "fixed": list(self.fixed),
            "load_law": self.load_law,
            "records": [
                {
                    "record": start.record,
                    "onset_s": start.onset_s,
                    "compared_s": list(start.compared_s),
                    "load_level": start.load_level.value,
                    "load_level_ci95": _interval(start.load_level.ci95),
                    "time_offset_s": start.time_offset_s.value,
                    "time_offset_s_ci95": _interval(start.time_offset_s.ci95),
                    "residual_rms_A": start.residual_rms_A,
                    "residual_share": start.residual_share,
                    "load_change": _load_change(start.load_change),
                }
                for start in self.starts
            ],
            "condition_number": self.condition_number if finite else None,
            "reasons": list(self.reasons),
            "warnings": list(self.warnings),
            "evaluations": self.evaluations,
            "compute_seconds": self.compute_seconds,
        }


def _estimate(one: Estimate) -> dict[str, object]:
    return {"value": one.value, "ci95": _interval(one.ci95), "fixed": one.fixed}


def _load_change(one: LoadChange | None) -> dict[str, object] | None:
    if one is None:
        return None
    return {
        "change": one.change.value,
        "change_ci95": _interval(one.change.ci95),
        "begins_s": one.begins_s,
        "lasts_s": one.lasts_s,
        "kind": "step" if one.is_step else "rise",
    }


def _interval(interval: Interval | None) -> list[float] | None:
    return None if interval is None else list(interval)
