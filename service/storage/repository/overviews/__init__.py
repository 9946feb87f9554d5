"""Lists of relays, motors and users with what belongs to each: a few queries a page, however long it is."""

from service.storage.repository.overviews.plant import PlantOverviewRows
from service.storage.repository.overviews.relays import RelayOverviewRows
from service.storage.repository.overviews.users import UserOverviewRows


class OverviewRows(RelayOverviewRows, PlantOverviewRows, UserOverviewRows):
    """All lists that show more than one table."""


__all__ = ["OverviewRows"]
