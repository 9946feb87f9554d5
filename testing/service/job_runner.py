"""A job runner without workers, for tests that bring the diagnoses themselves."""

from service.storage import Repository
from testing.service.plants import NOW_NS

RUNNER = "a runner of the tests"


def register_runner(repository: Repository) -> None:
    """Register RUNNER, which may claim jobs from then on."""
    repository.register_runner(RUNNER, installation="tests", now_ns=NOW_NS, max_attempts=3)
