"""Whether something is at one of somebody's sites."""

from collections.abc import Collection, Mapping
from enum import StrEnum

from service.storage.models import (
    AlarmRow,
    Base,
    DeletionRow,
    IedRow,
    MotorRow,
    RecordingRequestRow,
    RecordingRow,
    SiteRow,
)
from service.storage.repository.sessions import Sessions


class AtSite(StrEnum):
    """What is at a site, and has a key by which it is asked for."""

    SITE = "site"
    MOTOR = "motor"
    RELAY = "relay"
    RECORDING = "recording"
    RECORDING_REQUEST = "recording request"
    DELETION = "deletion"
    ALARM = "alarm"


TABLES: Mapping[AtSite, type[Base]] = {
    AtSite.SITE: SiteRow,
    AtSite.MOTOR: MotorRow,
    AtSite.RELAY: IedRow,
    AtSite.RECORDING: RecordingRow,
    AtSite.RECORDING_REQUEST: RecordingRequestRow,
    AtSite.DELETION: DeletionRow,
    AtSite.ALARM: AlarmRow,
}


class SiteRows(Sessions):
    def is_elsewhere(self, what: AtSite, key: str, sites: Collection[str]) -> bool:
        """Tell whether there is such a thing, at none of these sites. False where there is none at all."""
        table = TABLES[what]
        with self.within(sites)._read() as session:  # noqa: SLF001 - of the same class
            if session.get(table, key) is not None:
                return False
        with self.within(None)._read() as session:  # noqa: SLF001 - of the same class
            return session.get(table, key) is not None
