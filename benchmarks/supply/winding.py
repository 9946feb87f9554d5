"""Temperatures of windings from recordings, against those of the simulator's windings."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.reporting import rate_text, table
from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass
from core.thermal.winding_temperature import WindingTemperature, winding_temperature
from ied_sim.motor.warming import ALUMINIUM_PER_K, COPPER_PER_K
from testing.machines.disturbed_records import Disturbances, disturbed_record
from testing.machines.motors import ALL
from testing.machines.steady_faults import Condition

CASES = 16
CLASSES = {
    "usual protection, 1 %, 25 us": SensorClass(),
    "good, 0.2 %, 5 us": SensorClass(2e-3, 2e-3, 5e-6, 5e-6),
}
DIFFERENCES = {"the same load": 0.0, "loads up to 0.02 apart": 0.02, "loads up to 0.1 apart": 0.1}
SPREAD = 0.1
"""Of the motor's true inductances and resistances about those of its file."""
REFERENCE_C = 20.0


def measure() -> Iterator[str]:
    """Lines of the page."""
    yield (
        f"{CASES} pairs of 1.1 s records for each of three motors: load 0.4 to 1, winding 0 to 80 K hotter "
        f"in the second; true parameters within {SPREAD:.0%} of the file's; gains and delays of the six "
        "channels anywhere in their class, the same in both records; noise of 0.1 %."
    )
    yield ""
    rows = []
    for sensors_name, sensors in CLASSES.items():
        for difference_name, difference in DIFFERENCES.items():
            random = np.random.default_rng(11)
            found = [_case(motor, sensors, difference, random) for motor in ALL for _ in range(CASES)]
            told = [(hotter, one) for hotter, one in found if one.rise_K_ci95 is not None]
            held = sum(_holds(hotter, one) for hotter, one in told)
            errors = [abs((one.rise_K or 0.0) - hotter) for hotter, one in told]
            halves = [(one.rise_K_ci95[1] - one.rise_K_ci95[0]) / 2.0 for _, one in told if one.rise_K_ci95]
            rows.append(
                [
                    sensors_name,
                    difference_name,
                    rate_text(len(told), len(found)),
                    rate_text(held, len(told)),
                    f"{np.median(errors):.1f} / {np.quantile(errors, 0.95):.1f} K" if told else "-",
                    f"{np.median(halves):.0f} K" if told else "-",
                ]
            )
    header = ["sensors", "records", "told", "interval holds the truth", "error, median / 95 %", "half of it"]
    yield from table(header, rows)
    yield ""
    yield "Told: the interval is at most 30 K to either side. Half of it: the median of what is told."


def _holds(hotter_K: float, found: WindingTemperature) -> bool:
    return found.rise_K_ci95 is not None and found.rise_K_ci95[0] <= hotter_K <= found.rise_K_ci95[1]


def _case(
    motor: Motor, sensors: SensorClass, difference: float, random: np.random.Generator
) -> tuple[float, WindingTemperature]:
    """Return how much hotter the winding is in the second record, and what is told of it."""
    motor = replace(motor, sensors=sensors)
    load, hotter_K = random.uniform(0.4, 1.0), random.uniform(0.0, 80.0)
    factors = random.uniform(1.0 - SPREAD, 1.0 + SPREAD, 5)
    gains = np.concatenate([random.uniform(-1, 1, 3) * sensors.current_gain,
                            random.uniform(-1, 1, 3) * sensors.voltage_gain])  # fmt: skip
    delays = np.concatenate([random.uniform(-1, 1, 3) * sensors.current_delay_s,
                             random.uniform(-1, 1, 3) * sensors.voltage_delay_s])  # fmt: skip
    records: list[Observation] = []
    for K, at in ((0.0, load), (hotter_K, load + random.uniform(-difference, difference))):
        warm = factors * np.array([1.0 + COPPER_PER_K * K, 1.0 + ALUMINIUM_PER_K * K, 1.0, 1.0, 1.0])
        record = disturbed_record(
            motor,
            Condition(load_level=at),
            Disturbances(
                gain_errors=tuple(gains.tolist()),
                delays_s=tuple((delays - delays.min()).tolist()),
                parameter_factors=tuple(warm.tolist()),
                noise=1e-3,
            ),
            start_s=0.0,
            cycles=55.0,
            sample_rate_hz=8_000.0,
            seed=int(random.integers(2**31)),
        )
        seen = observe(record, motor)
        if seen is None:
            raise RuntimeError(f"the quality gate refused a record of {motor.name} at {at:.0%} load")
        records.append(seen)
    return hotter_K, winding_temperature(records[1], records[0], motor, reference_C=REFERENCE_C)
