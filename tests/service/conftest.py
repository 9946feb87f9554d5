from tests.service.fixtures import migrated_sqlite, postgresql, postgresql_url
from tests.service.s3_fixtures import new_clients, place, s3, s3_process

__all__ = ["migrated_sqlite", "new_clients", "place", "postgresql", "postgresql_url", "s3", "s3_process"]
