"""Diagnoses made in worker processes, taken from the queue in the database."""

from service.jobs.runner import JobRunner
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected, Task

__all__ = ["Diagnosed", "DiagnosisTask", "JobRunner", "Outcome", "Rejected", "Task"]
