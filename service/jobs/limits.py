"""How many diagnoses are made at once, how long each may take, and how often it is tried."""

from dataclasses import dataclass

from service.timing.backoff import Backoff


@dataclass(frozen=True, slots=True)
class JobLimits:
    """Hold what the settings say of jobs.

    workers: how many at once.  job_timeout_s: how long each may take.  attempts: how often it is tried.
    backoff: pauses before it is tried again.  lease_s: others do the jobs of a runner that has not renewed
    its lease for so long.
    """

    workers: int
    job_timeout_s: float
    attempts: int
    backoff: Backoff
    lease_s: float
