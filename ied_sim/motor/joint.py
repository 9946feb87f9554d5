"""A bad joint: contact resistance in the line to one terminal, between the voltage sensors and the motor."""

from dataclasses import dataclass

from ied_sim.motor.course import Points, value_at


@dataclass(frozen=True, slots=True)
class JointCourse:
    """Extra contact resistance in the line to terminal 0, 1 or 2 (a, b, c) as it develops.

    The points are (time [s], resistance [ohm]), joined by lines.
    """

    phase: int
    course: Points

    def resistance_ohm(self, time_s: float) -> float:
        """Return the resistance at one moment."""
        return value_at(self.course, time_s)
