"""What pages may be narrowed to, and reports be of: the plant's motors and sites."""

from collections.abc import Sequence

from service.storage.repository import Repository

PAGE = 500


def motor_names(repository: Repository) -> Sequence[str]:
    """Return the motors in service, by name."""
    return sorted(repository.schedules())


def site_names(repository: Repository) -> Sequence[str]:
    """Return the sites, by name."""
    names: list[str] = []
    after = None
    while True:
        page = repository.sites(limit=PAGE, after=after)
        names += (site.name for site in page.items)
        after = page.next
        if after is None:
            return names
