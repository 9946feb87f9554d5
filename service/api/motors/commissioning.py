"""What is offered of recordings in which a motor starts."""

import shlex


def offer(motor: str, starts: int) -> str:
    """Return the advice to estimate a motor's parameters from the starts that were recorded."""
    seen = "a start was recorded" if starts == 1 else f"{starts} starts were recorded"
    return f"{seen}: mcc commission --from-service {shlex.quote(motor)} --write motors.toml"
