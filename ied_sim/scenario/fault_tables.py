"""Tables of a scenario file about the stator: its winding by slots, and its shorted turns."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.slots import SlotWinding
from ied_sim.scenario.moments import MomentTable, require_rising
from ied_sim.toml_tables import Table

Turns = Annotated[float, Field(ge=0, le=0.5)]
CoilShare = Annotated[float, Field(ge=0, le=1)]
Resistance = Annotated[float, Field(ge=0)]
Phase = Literal["a", "b", "c"]


class WindingTable(Table):
    """The stator's winding by its slots."""

    kind: Literal["lap", "concentric"]
    slots: Annotated[int, Field(ge=6, le=288)]
    layers: Literal[1, 2] = 2
    coil_pitch_slots: Annotated[int, Field(ge=1)] | None = None
    branches: Annotated[int, Field(ge=1, le=12)] = 1

    def winding(self) -> SlotWinding:
        """Return the winding."""
        return SlotWinding(self.kind, self.slots, self.layers, self.coil_pitch_slots, self.branches)


class TimelinePointTable(MomentTable):
    """One point of a fault's development."""

    level: Turns | None = None
    coil_share: CoilShare | None = None

    @model_validator(mode="after")
    def _has_one_size(self) -> Self:
        if (self.level is None) == (self.coil_share is None):
            raise ValueError("give either level or coil_share")
        return self


class FaultTable(Table):
    """Shorted turns of a phase or of one of its coils, of a constant size or one that develops."""

    phase: Phase
    coil: Annotated[int, Field(ge=1)] | None = None
    level: Turns | None = None
    coil_share: CoilShare | None = None
    timeline: Annotated[tuple[TimelinePointTable, ...], Field(min_length=1)] | None = None
    resistance_ohm: Resistance = 0.0
    path_ratio: Annotated[float, Field(ge=0, le=100)] | None = None

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        given = [self.level, self.coil_share, self.timeline]
        if sum(one is not None for one in given) != 1:
            raise ValueError("give either level or timeline, or coil_share with a coil")
        require_rising([point.time_s for point in self.timeline or ()], "timeline")
        return self

    @model_validator(mode="after")
    def _counts_turns_of_the_coil_where_it_names_one(self) -> Self:
        points = self.timeline or ()
        shares = self.coil_share is not None or any(point.coil_share is not None for point in points)
        levels = self.level is not None or any(point.level is not None for point in points)
        if (self.coil is None and shares) or (self.coil is not None and levels):
            raise ValueError("coil and coil_share belong together; level is that of a fault without a coil")
        return self

    @model_validator(mode="after")
    def _has_one_path(self) -> Self:
        if self.path_ratio is not None and self.resistance_ohm:
            raise ValueError("give either resistance_ohm or path_ratio")
        return self

    def course(self, stator_resistance_ohm: float, winding: SlotWinding | None) -> FaultCourse:
        """Return the fault's development in a motor.

        Raises ValueError where the motor's winding has no such coil.
        """
        path_ohm = (self.path_ratio or 0.0) * stator_resistance_ohm
        phase = "abc".index(self.phase)
        if self.coil is None:
            return FaultCourse(phase, self._points(1), self.resistance_ohm, path_ohm)
        if winding is None:
            raise ValueError("a coil, and no [motor.winding] that has it")
        N, branches = winding.coils_per_phase(), winding.branches
        if self.coil > N:
            raise ValueError(f"{self.coil}, and a phase has {N} coils")
        return FaultCourse(
            phase, self._points(N), self.resistance_ohm, path_ohm * branches**2, self.coil, branches
        )

    def _points(self, coils: int) -> tuple[tuple[float, float], ...]:
        """Return the share of the phase's turns over time."""
        if self.timeline is None:
            return ((0.0, (self.level or self.coil_share or 0.0) / coils),)
        return tuple((p.time_s, (p.level or p.coil_share or 0.0) / coils) for p in self.timeline)
