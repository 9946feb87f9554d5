"""Follow a relay's thermal element through a shift: python examples/thermal_capacity.py"""

from core.thermal import relay_model, two_bodies
from core.thermal.course import CurrentStep

SETTINGS = relay_model.RelaySettings(service_factor=1.15, locked_rotor_current=6.0, locked_rotor_time_s=12.0)
SHIFT = (
    ("a start of 4 s", CurrentStep(4.0, 5.8)),
    ("two hours at 80 %", CurrentStep(7200.0, 0.8)),
    ("half an hour at 110 %, currents uneven by 4 %", CurrentStep(1800.0, 1.1, 0.044)),
    ("an hour at rest", CurrentStep(3600.0, 0.0)),
    ("another start", CurrentStep(4.0, 5.8)),
)
"""Currents over the full-load current, as the load profile of a relay has them."""


def main() -> None:
    relay, rises = relay_model.cold(SETTINGS), two_bodies.Rises()
    for what, step in SHIFT:
        relay = relay_model.after(relay, [step], SETTINGS)
        rises = two_bodies.after(rises, [step], two_bodies.TwoBodies())
        print(f"{relay.thermal_capacity_used:6.1%} used, winding {rises.winding_K:3.0f} K, after {what}")


if __name__ == "__main__":
    main()
