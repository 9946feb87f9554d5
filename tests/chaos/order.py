"""What somebody wants run."""

from dataclasses import dataclass

OVERHEAD_S = 45.0
"""Of a run, for its start and its settling; the rest is the schedule's."""

SHORTEST_S = 20.0


@dataclass(frozen=True, slots=True)
class Order:
    """minutes: about how long it may take, start and settling included.

    faults: so many times the usual number of faults a minute. The usual one is for runs of minutes: the
    service is hurt every eight seconds, and hardly gets to work.  database: "sqlite" or "postgresql".
    """

    seed: int
    minutes: float
    recordings: int
    relays: int
    faults: float = 1.0
    database: str = "sqlite"

    @property
    def schedule_s(self) -> float:
        """How long triggers and faults go on."""
        return max(SHORTEST_S, 60.0 * self.minutes - OVERHEAD_S)

    @property
    def command(self) -> str:
        """What runs the same again."""
        return (
            f"make chaos SEED={self.seed} MINUTES={self.minutes:g} RECORDINGS={self.recordings} "
            f"RELAYS={self.relays}"
            + (f" FAULTS={self.faults:g}" if self.faults != 1.0 else "")
            + (f" DATABASE={self.database}" if self.database != "sqlite" else "")
        )
