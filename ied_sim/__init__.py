"""The simulated relay: a motor with physics of its own behind an event recorder and an IEC 61850 server."""


def warm_up() -> None:
    """Compile the motor's equations, or load them from the cache of an earlier run."""
    # Imported here, because an import of the package must not load the compiler.
    from ied_sim.scenario.scenario import healthy_reference

    healthy_reference("warm-up").plant.operation(0.0, 0.002, 10_000.0, settling_s=0.0)


__all__ = ["warm_up"]
