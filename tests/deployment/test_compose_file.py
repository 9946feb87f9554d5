"""The compose file and the image, as far as they can be judged without an engine."""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

import scl
from scl.demo_enterprise import WAN, write_demo_enterprise

ROOT = Path(__file__).parents[2]
DOCKERFILE = (ROOT / "Dockerfile").read_text(encoding="utf-8")


def composition() -> Mapping[str, Mapping[str, Mapping[str, object]]]:
    found = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


SERVICES = composition()["services"]


def test_images_are_pinned() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert {service["image"] for service in SERVICES.values()} == {f"localhost/statorwatch:{version}"}
    bases = re.findall(r"^FROM (\S+)", DOCKERFILE, re.MULTILINE)
    assert set(bases) == {"docker.io/library/python:3.11-slim-bookworm"}


@pytest.mark.parametrize("name", SERVICES)
def test_no_container_has_rights_it_does_not_need(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert not service.keys() & {"cap_add", "privileged", "user", "devices", "network_mode", "pid"}


def test_the_image_is_not_run_as_root() -> None:
    users = re.findall(r"^USER (\S+)", DOCKERFILE, re.MULTILINE)
    assert users == ["10001:10001"]


def test_only_the_api_is_seen_and_only_from_this_host() -> None:
    published = {name: service["ports"] for name, service in SERVICES.items() if "ports" in service}
    assert published == {"mcc": ["127.0.0.1:${MCC_HOST_PORT:-8710}:8710"]}
    networks = composition()["networks"]
    assert {name for name, network in networks.items() if network and network.get("internal")} == {
        "factory_a",
        "factory_b",
    }


def test_hosts_are_those_of_the_scd(tmp_path: Path) -> None:
    write_demo_enterprise(tmp_path / "plant.scd")
    plant = scl.read(tmp_path / "plant.scd")
    assert plant.warnings == ()
    sites = {feeder.ied: feeder.site for feeder in plant.feeders()}
    for ied, site in sites.items():
        inside, outside = plant.address(ied), plant.seen_from(WAN).address(ied)
        assert inside.port == scl.Address("host").port, "the standard's"
        relay, router = SERVICES[inside.host], SERVICES[outside.host]
        assert relay["networks"] == [site.lower()]
        assert router["networks"] == [site.lower(), "wan"]
        command = relay["command"]
        assert isinstance(command, list)
        assert command[-2:] == ["--ied", ied]
    assert SERVICES["mcc"]["networks"] == ["wan"]
    environment = SERVICES["mcc"]["environment"]
    assert isinstance(environment, dict)
    assert environment["MCC_SUBNETWORK"] == WAN
