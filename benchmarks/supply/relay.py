"""The relay's thermal element against the trip times that its manual prints."""

from collections.abc import Iterator

from benchmarks.reporting import table
from core.thermal.course import CurrentStep
from core.thermal.relay_model import HOT, RelaySettings, RelayState, after, cold

PRINTED_S = {
    1.1: 3183.0, 1.2: 1717.0, 1.3: 1150.0, 1.4: 848.3, 1.5: 662.1, 2.0: 285.1, 2.45: 172.7, 3.0: 100.0,
    4.0: 56.25, 5.0: 36.0, 6.0: 25.0, 7.0: 18.37, 8.0: 14.06, 9.0: 11.11, 10.0: 9.0, 12.0: 6.25,
}  # fmt: skip
CURVE = 10


def measure() -> Iterator[str]:
    """Lines of the page."""
    yield (
        "SEL-749M Instruction Manual (20080918), table 4.5, curve 10 at a service factor of 1.01: hot stator "
        "below 2.5 times full load, cold rotor above."
    )
    yield ""
    settings = RelaySettings(1.01, 6.0, 2.08 * CURVE)
    hot = after(cold(settings), [CurrentStep(1e7, HOT * settings.service_factor)], settings)
    rows, worst = [], 0.0
    for current, printed_s in PRINTED_S.items():
        found_s = _trip_s(hot if current < 2.5 else cold(settings), current, settings)
        worst = max(worst, abs(found_s / printed_s - 1.0))
        rows.append([f"{current:g}", f"{printed_s:g}", f"{found_s:.4g}", f"{found_s / printed_s - 1.0:+.2%}"])
    yield from table(["current over full load", "printed s", "found s", "difference"], rows)
    yield ""
    yield f"Greatest difference {worst:.2%}; the manual rounds 2.496 s to 2.5 s a curve number."


def _trip_s(state: RelayState, current: float, settings: RelaySettings) -> float:
    low, high = 0.0, 1e5
    while high - low > 1e-6 * high:
        middle = (low + high) / 2.0
        used = after(state, [CurrentStep(middle, current)], settings).thermal_capacity_used
        low, high = (low, middle) if used >= 1.0 else (middle, high)
    return high
