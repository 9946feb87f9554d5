"""The true condition of the simulated motors, from the simulator itself, so that it is defined once."""

import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

T = TypeVar("T")

TIMEOUT_S = 60.0


class TruthError(RuntimeError):
    """The simulator did not report the condition of its motors."""


class ChannelError(BaseModel):
    """By how much a channel has changed since the scenario's beginning."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    gain: float
    delay_us: float


class PulsationTruth(BaseModel):
    """A pulsation of the load's torque: its amplitude over the rated torque."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    depth: float


class Truth(BaseModel):
    """Condition of one simulated motor: equivalent fault level, faulted winding, load over rated torque.

    running: False where it stands still.
    broken_bars: number of broken bars of the cage, of `bars`.
    pulsations: those of the load's torque.
    channels: those that have changed since the scenario's beginning.
    """

    model_config = ConfigDict(extra="ignore", frozen=True)

    running: bool = True
    mu_f: float
    theta_f: int | None
    load_level: float
    joint_ohm: float = 0.0
    broken_bars: float = 0.0
    bars: int = 28
    pulsations: tuple[PulsationTruth, ...] = ()
    channels: Mapping[str, ChannelError] = {}

    @property
    def verdict(self) -> str:
        """The right verdict."""
        return "healthy" if self.theta_f is None else "fault"

    def as_dict(self) -> dict[str, object]:
        """As a document; what is not wrong with joints, rotor, load and channels is left out."""
        return self.model_dump(exclude_defaults=True)

    @property
    def phase(self) -> str | None:
        return None if self.theta_f is None else "abc"[self.theta_f]


_TRUTHS = TypeAdapter(dict[str, Truth])
_COURSE = TypeAdapter(list[dict[str, Truth]])


def ask_simulator(scd: Path, scenario: Path, at_s: float = 0.0) -> Mapping[str, Truth]:
    """Return the true condition of each simulated relay's motor, by name of the relay.

    at_s: since the scenario's beginning. Raises TruthError.
    """
    return _ask(scd, scenario, [at_s], _TRUTHS)


def ask_course(scd: Path, scenario: Path, at_s: Sequence[float]) -> Sequence[Mapping[str, Truth]]:
    """Return the true conditions at several moments, two or more. Raises TruthError."""
    return _ask(scd, scenario, at_s, _COURSE)


def _ask(scd: Path, scenario: Path, at_s: Sequence[float], answers: TypeAdapter[T]) -> T:
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(scenario), "--truth"]
    for moment_s in at_s:
        command += ["--at", f"{moment_s:.3f}"]
    try:
        answer = subprocess.run(  # noqa: S603 - our own module
            command,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=True,
            start_new_session=True,  # so that Ctrl-C reaches the demo alone
        )
        return answers.validate_json(answer.stdout)
    except subprocess.CalledProcessError as error:
        raise TruthError(f"ied-sim --truth ended with {error.returncode}: {error.stderr.strip()}") from error
    except (subprocess.TimeoutExpired, ValidationError) as error:
        raise TruthError(f"ied-sim --truth: {error}") from error
