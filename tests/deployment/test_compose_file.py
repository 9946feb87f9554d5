"""The compose file and the image, as far as they can be judged without an engine."""

import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

import scl
from scl.demo_enterprise import WAN, write_demo_enterprise
from tests.deployment import several_hosts
from tests.deployment.composing import ROOT
from tests.deployment.documented import blocks
from tests.deployment.image import base_images, commands_running, instructions


def composition() -> Mapping[str, Mapping[str, Mapping[str, object]]]:
    found = yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


SERVICES = composition()["services"]
LAID_OVER = yaml.safe_load((ROOT / several_hosts.LAID_OVER).read_text(encoding="utf-8"))["services"]
HOSTS = (*several_hosts.WORKERS, several_hosts.GATEWAY)


def test_images_are_pinned() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert {service["image"] for service in SERVICES.values()} == {f"localhost/statorwatch:{version}"}
    assert set(base_images()) == {"docker.io/library/python:3.11-slim-bookworm"}


def test_what_builds_the_wheel_is_pinned_too() -> None:
    (pinning,) = commands_running(">", "build-constraints.txt")
    echo, requirement, *_ = pinning
    name, _, version = requirement.partition("==")
    assert (echo, name) == ("echo", "setuptools")
    assert version.replace(".", "").isdecimal()
    (added,) = commands_running(">>", "build-constraints.txt")
    assert added[:2] == ["cat", "constraints.txt"]
    (wheel,) = commands_running("pip", "wheel")
    for setting in ("PIP_CONSTRAINT", "PIP_BUILD_CONSTRAINT"):
        assert f"{setting}=/src/build-constraints.txt" in wheel[: wheel.index("python")]


def test_one_service_builds_and_no_registry_is_asked() -> None:
    assert {service["pull_policy"] for service in SERVICES.values()} == {"never"}
    assert [name for name, service in SERVICES.items() if "build" in service] == ["mcc"]


@pytest.mark.parametrize("name", SERVICES)
def test_what_a_container_may_use_is_bounded(name: str) -> None:
    service = SERVICES[name]
    memory_files, memory = ("256m", "2g") if name == "mcc" else ("64m", "512m")
    assert service["tmpfs"] == [f"/tmp:size={memory_files}"]  # noqa: S108 - the container's own
    assert service["mem_limit"] == memory
    assert service["pids_limit"] == 256


@pytest.mark.parametrize("name", SERVICES)
def test_no_container_has_rights_it_does_not_need(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert not service.keys() & {"cap_add", "privileged", "user", "devices", "network_mode", "pid"}
    port_102 = ["net.ipv4.ip_unprivileged_port_start=102"] if name.startswith("relay-") else None
    assert service.get("sysctls") == port_102


def test_the_image_is_not_run_as_root() -> None:
    assert instructions("USER") == ["10001:10001"]


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
    for name, site in (("router-a", "FACTORY_A"), ("router-b", "FACTORY_B")):
        check = SERVICES[name]["healthcheck"]
        assert isinstance(check, dict)
        ports = list(sites.values()).count(site)
        assert check["test"].endswith(f"| grep -qx {ports}"), "one port for each relay"


def test_the_lines_for_backup_and_restore_are_found() -> None:
    back_up, restore = (block.splitlines() for block in blocks("Back-up and restore"))
    assert all(line.startswith("docker compose ") for line in back_up[:3] + restore)
    assert back_up[3:] == ["tar -tf backup.tar > /dev/null && echo whole"]
    assert back_up[1].endswith("> backup.tar")
    assert restore[1].endswith("< backup.tar")


def test_hosts_that_are_laid_over_run_the_same_image_with_as_few_rights() -> None:
    assert set(LAID_OVER) == {"database", "mcc", *HOSTS}
    for name in HOSTS:
        for key in ("image", "pull_policy", "restart", "read_only", "cap_drop", "security_opt", "pids_limit"):
            assert LAID_OVER[name][key] == SERVICES["mcc"][key], f"{name}: {key}"
        assert not LAID_OVER[name].keys() & {"cap_add", "privileged", "user", "ports", "network_mode", "pid"}


def test_hosts_that_are_laid_over_share_the_database_and_the_recordings_alone() -> None:
    shared = LAID_OVER["mcc"]["environment"]
    for name in HOSTS:
        assert shared.items() <= LAID_OVER[name]["environment"].items()
        assert LAID_OVER[name]["volumes"] == LAID_OVER["mcc"]["volumes"] == ["recordings:/recordings"]
        assert "storage" in LAID_OVER[name]["networks"]


def test_no_password_stands_in_a_compose_file() -> None:
    asked_for = "${MCC_DATABASE_PASSWORD:?a password of your choice, for the database}"
    assert LAID_OVER["database"]["environment"]["POSTGRES_PASSWORD"] == asked_for
    assert LAID_OVER["mcc"]["environment"]["PGPASSWORD"] == asked_for
    assert "@database/" in LAID_OVER["mcc"]["environment"]["MCC_DATABASE_URL"]
    assert "ports" not in LAID_OVER["database"]
