"""Whether the latest start of a motor shows of the rotor's cage what the running motor shows."""

from dataclasses import dataclass
from typing import Final

from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband, agreement
from service.storage import Repository
from service.storage.records import StartEntry

MOST_STARTS: Final = 20
MOST_RECORDS: Final = 50
"""So many of the latest are looked through for one that can tell."""


@dataclass(frozen=True, slots=True)
class StartAgreement:
    """What a start shows beside what the running motor shows.

    agrees: None where one of them cannot see what the other shows. words: the comparison.
    """

    start: StartEntry
    sideband: StartSideband
    agrees: bool | None
    words: str


def start_agreement(repository: Repository, motor: str) -> StartAgreement | None:
    """Compare the latest start and the latest running record that can tell; None where there are not both.

    Raises NotFoundError.
    """
    records = repository.latest_rotor_findings(motor, limit=MOST_RECORDS)
    running = [one.finding for one in records if one.finding.state is not RotorState.UNSUPPORTED]
    if not running:
        return None
    for start in repository.starts(motor, limit=MOST_STARTS).items:
        sideband = start.examined.sideband
        if sideband is not None and sideband.state is not RotorState.UNSUPPORTED:
            agrees, words = agreement(running[-1], sideband)
            return StartAgreement(start, sideband, agrees, words)
    return None
