"""docs/reference/settings.md and docs/reference/api.md name what there is, and nothing else."""

import re
from dataclasses import fields
from pathlib import Path
from typing import get_args

from pydantic import BaseModel

from service.api import ApiContext, create_app
from service.configuration.access import AccessSettings, OidcSettings, ProxySettings
from service.configuration.alarms import AlarmSettings
from service.configuration.audit import AuditSettings, AuditSyslog
from service.configuration.backup import BackupSettings
from service.configuration.channels import (
    AppriseChannel,
    CommandChannel,
    MailChannel,
    SyslogChannel,
    WebhookChannel,
)
from service.configuration.gateways.mqtt import SparkplugSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.notifications import Digest, NotificationSettings, Route
from service.configuration.retention import RetentionSettings
from service.configuration.settings import Settings
from service.plant import Overrides
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect

DOCS = Path(__file__).parents[2] / "docs"


def test_every_setting_is_documented() -> None:
    rows = re.findall(
        r"^\| `(\w+)` \|", (DOCS / "reference" / "settings.md").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert sorted(rows) == sorted(Settings.model_fields)


def test_every_rule_of_retention_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `retention\.(\w+)`", page, re.MULTILINE)
    assert rows == list(RetentionSettings.model_fields)


def test_every_setting_of_the_audit_trail_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `audit\.(\w+)` \|(.*)$", page, re.MULTILINE)
    assert [name for name, _ in rows] == list(AuditSettings.model_fields)
    keys = set(re.findall(r"`(\w+)`", dict(rows)["syslog"])) - {"syslog", "audit"}
    assert keys == set(AuditSyslog.model_fields) - {"kind"}


def test_every_setting_of_access_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `access\.([\w.]+)`", page, re.MULTILINE)
    inner: dict[str, type[BaseModel]] = {"proxy": ProxySettings, "oidc": OidcSettings}
    assert rows == [
        *AccessSettings.model_fields,
        *(f"{table}.{name}" for table, model in inner.items() for name in model.model_fields),
    ]


def test_every_setting_of_the_back_up_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `backup\.(\w+)`", page, re.MULTILINE)
    assert rows == list(BackupSettings.model_fields)


def test_every_setting_of_the_gateways_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    section = page.partition("## The plant's other systems\n")[2].partition("\n## ")[0]
    for kind, field in GatewaysSettings.model_fields.items():
        (model,) = (one for one in get_args(field.annotation) if one is not type(None))
        assert re.findall(rf"^\| `{kind}\.(\w+)` \|", section, re.MULTILINE) == list(model.model_fields), kind


def test_every_setting_of_the_sparkplug_edge_node_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `mqtt\.sparkplug\.(\w+)` \|", page, re.MULTILINE)
    assert rows == list(SparkplugSettings.model_fields)


def test_every_setting_of_the_alarms_is_documented_with_its_default_and_range() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `alarms\.(\w+)` \| ([\d.]+) \(([\d.]+) to ([\d.]+)\) \|", page, re.MULTILINE)
    documented = {name: tuple(map(float, figures)) for name, *figures in rows}
    schema = AlarmSettings.model_json_schema()["properties"]
    assert documented == {
        name: (found["default"], found["minimum"], found["maximum"]) for name, found in schema.items()
    }


def test_every_setting_of_notifications_is_documented() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| `notifications\.(\w+)`", page, re.MULTILINE) == list(
        NotificationSettings.model_fields
    )
    section = page.partition("## Notifications\n")[2].partition("\n## ")[0]
    documented: dict[str, list[str]] = {}
    for cell in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE):
        for table, key in re.findall(r"`(?!notifications)(\w+)\.(\w+)`", cell):
            documented.setdefault(table, []).append(key)
    channels = (MailChannel, WebhookChannel, SyslogChannel, CommandChannel, AppriseChannel)
    tables = {get_args(one.model_fields["kind"].annotation)[0]: one for one in channels}
    assert set(documented) == {*tables, "routes", "digests"}
    for name, table in (*tables.items(), ("routes", Route), ("digests", Digest)):
        assert sorted(documented[name]) == sorted(_keys(table) - {"kind", "timeout_s"}), name


def _keys(table: type[BaseModel]) -> set[str]:
    return {field.alias or name for name, field in table.model_fields.items()}


def test_the_documented_ranges_and_defaults_are_those_of_the_settings() -> None:
    page = (DOCS / "reference" / "settings.md").read_text(encoding="utf-8")
    number = r"`?([\d.]+)`?(?: \([^|]*\))?"
    rows = re.findall(rf"^\| `(\w+)` \| {number} \| {number} to {number} \|", page, re.MULTILINE)
    documented = {
        name: (float(default), float(least), float(largest)) for name, default, least, largest in rows
    }
    schema = Settings.model_json_schema()["properties"]
    assert documented == {
        name: (found["default"], found["minimum"], found["maximum"])
        for name, found in schema.items()
        if found.get("type") in ("number", "integer")
    }


def test_every_decision_about_a_relay_is_documented() -> None:
    page = (DOCS / "reference" / "relays.md").read_text(encoding="utf-8")
    keys = re.findall(r"^(\w+) = .*$", page.partition("[motor.relay]\n")[2].partition("```")[0], re.MULTILINE)
    assert sorted(keys) == sorted(field.name for field in fields(Overrides))


def test_every_route_is_documented(tmp_path: Path) -> None:
    repository = Repository(connect(f"sqlite:///{tmp_path / 'unused.sqlite'}"))
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    routes = {
        f"{method.upper()} {path}" for path, methods in app.openapi()["paths"].items() for method in methods
    }
    rows = re.findall(
        r"^\| `([A-Z]+ /\S+)` \|", (DOCS / "reference" / "api.md").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert sorted(rows) == sorted(routes)
