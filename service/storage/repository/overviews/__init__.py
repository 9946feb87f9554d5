"""What pages list: motors, relays and users with what belongs to each, and stamps that tell when it changes.

A few queries a page, however long it is.
"""

from service.storage.repository.overviews.change_stamps import ChangeStampRows
from service.storage.repository.overviews.fleet import FleetRows
from service.storage.repository.overviews.plant import PlantOverviewRows
from service.storage.repository.overviews.relays import RelayOverviewRows
from service.storage.repository.overviews.users import UserOverviewRows


class OverviewRows(FleetRows, RelayOverviewRows, PlantOverviewRows, UserOverviewRows, ChangeStampRows):
    """All that shows more than one table."""


__all__ = ["OverviewRows"]
