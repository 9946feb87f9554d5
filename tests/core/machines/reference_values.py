"""Reference currents for the accuracy tests: the page's equations by DOP853 at rtol 1e-10, from rest for 2 s.

Every model, rating and level is started at rated voltage with 3 % unbalance and 2 % fifth harmonic. Explicit
Runge-Kutta needs minutes for the stiff loop of a small shorted winding, so the values are kept in a file:

    python -m tests.core.machines.reference_values            writes it anew
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Connection, Motor
from testing.machines.motors import ALL, MEDIUM, REFERENCE
from testing.machines.page_equations import integrate

Array = NDArray[np.float64]

FILE = Path(__file__).with_name("reference_values.npz")
LEVELS = (0.0, 1e-4, 1e-3, 0.01, 0.1, 0.2)
MODELS = ("split-winding", "shorted-winding", "high-resistance")
WINDING, LOAD_LEVEL = 1, 0.6
RATE_HZ, SAMPLES = 10_000.0, 20_001
START = np.arange(0, 6_000, 31)
"""Samples of the start that are kept, at ever other places in the cycle."""
STEADY = np.arange(19_000, SAMPLES, 7)
BROKEN_BARS = (REFERENCE, MEDIUM)
BROKEN_SHARE, BROKEN_SAMPLES = 0.05, 100_001
BROKEN = np.arange(50_000, BROKEN_SAMPLES, 37)
"""Samples kept of 10 s with broken bars, for a spectrum of the last 5 s."""
W_S = 2.0 * np.pi * 50.0
FIFTH, NEGATIVE = 0.02, 0.03


def winding_voltage(motor: Motor) -> float:
    """Length of the rated voltage's space vector: sqrt(3) times the rms voltage of a winding [V]."""
    delta = motor.nameplate.connection is Connection.DELTA
    return motor.nameplate.rated_voltage_V * (np.sqrt(3.0) if delta else 1.0)


def voltage_at(motor: Motor, t: Array | float, *, negative: float = NEGATIVE, fifth: float = FIFTH) -> Array:
    """A supply with unbalance and a fifth harmonic on the windings, in Clarke axes, shape (2, times) [V]."""
    volts = winding_voltage(motor)
    angle = W_S * np.asarray(t)
    forward = np.array([np.cos(angle), np.sin(angle)])
    backward = negative * np.array([np.cos(angle + 0.7), -np.sin(angle + 0.7)])
    harmonic = fifth * np.array([np.cos(5 * angle), -np.sin(5 * angle)])
    return np.asarray(volts * (forward + backward + harmonic), dtype=np.float64)


def key(model: str, motor: Motor, level: float) -> str:
    """Name of a case in the file; without a fault every model is the healthy machine."""
    return f"{model if level else 'healthy'} {motor.name} {level:g}"


def compute(model: str, motor: Motor, level: float) -> NDArray[np.float32]:
    """i_s alpha, i_s beta [A] and electrical speed [rad/s] at START and STEADY, shape (3, instants)."""
    times = np.concatenate([START, STEADY]) / RATE_HZ
    current, speed = integrate(
        model if level else "healthy", motor, level, WINDING, LOAD_LEVEL, lambda t: voltage_at(motor, t),
        np.zeros(5), 0.0, times,
    )  # fmt: skip
    return np.vstack([current, speed]).astype(np.float32)


def compute_broken_bars(motor: Motor) -> NDArray[np.float32]:
    """i_s alpha, i_s beta and speed of a machine with broken bars at BROKEN, balanced supply."""
    times = np.concatenate([[0], BROKEN]) / RATE_HZ
    current, speed = integrate(
        "healthy", motor, 0.0, 0, LOAD_LEVEL,
        lambda t: voltage_at(motor, t, negative=0.0, fifth=0.0), np.zeros(5), 0.0, times,
        broken_share=BROKEN_SHARE,
    )  # fmt: skip
    return np.vstack([current, speed])[:, 1:].astype(np.float32)


def main() -> None:
    values: dict[str, NDArray[np.float32]] = {}
    for motor in ALL:
        for model in MODELS:
            for level in LEVELS:
                name = key(model, motor, level)
                if name not in values:
                    values[name] = compute(model, motor, level)
    for motor in BROKEN_BARS:
        values[f"broken-bars {motor.name}"] = compute_broken_bars(motor)
    with FILE.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **values)


if __name__ == "__main__":
    main()
