"""The settings in words, for the audit trail: those that have not their default, and no password."""

from collections.abc import Iterator, Mapping

from sqlalchemy.engine import make_url

from service.configuration.settings import Settings


def described(settings: Settings) -> Mapping[str, object]:
    """Return each setting that has not its default, by its name with dots between."""
    values = settings.model_dump(mode="json", exclude_defaults=True)
    if "database_url" in values:
        values["database_url"] = make_url(settings.database_url).render_as_string(hide_password=True)
    return dict(_flat(values, ""))


def _flat(values: Mapping[str, object], before: str) -> Iterator[tuple[str, object]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield f"{before}{name}", value
