from tests.service.fixtures import migrated_sqlite, postgresql, postgresql_url

__all__ = ["migrated_sqlite", "postgresql", "postgresql_url"]
