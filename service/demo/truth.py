"""The true condition of the simulated motors, from the simulator itself, so that it is defined once."""

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

TIMEOUT_S = 60.0


class TruthError(RuntimeError):
    """The simulator did not report the condition of its motors."""


class Truth(BaseModel):
    """Condition of one simulated motor: equivalent fault level, faulted winding, load over rated torque."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    mu_f: float
    theta_f: int | None
    load_level: float

    @property
    def verdict(self) -> str:
        """The right verdict."""
        return "healthy" if self.theta_f is None else "fault"

    @property
    def phase(self) -> str | None:
        return None if self.theta_f is None else "abc"[self.theta_f]


_TRUTHS = TypeAdapter(dict[str, Truth])


def ask_simulator(scd: Path, scenario: Path) -> Mapping[str, Truth]:
    """Return the true condition of each simulated relay's motor, by name of the relay. Raises TruthError."""
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(scenario), "--truth"]
    try:
        answer = subprocess.run(  # noqa: S603 - our own module
            command,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=True,
            start_new_session=True,  # so that Ctrl-C reaches the demo alone
        )
        return _TRUTHS.validate_json(answer.stdout)
    except subprocess.CalledProcessError as error:
        raise TruthError(f"ied-sim --truth ended with {error.returncode}: {error.stderr.strip()}") from error
    except (subprocess.TimeoutExpired, ValidationError) as error:
        raise TruthError(f"ied-sim --truth: {error}") from error
