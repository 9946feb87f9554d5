"""Which schedulers are used: those of this host, and beyond it those with certificates."""

from pathlib import Path

import pytest

from service.configuration.dask import DaskTls, SchedulerAddressError, require_guarded
from service.configuration.settings import Settings, SettingsError
from testing.relays.certificates import identity


@pytest.fixture
def tls(tmp_path: Path) -> DaskTls:
    authority = identity(tmp_path, "authority", authority=True)
    own = identity(tmp_path, "own", issuer=authority)
    return DaskTls(ca=authority.certificate_file, certificate=own.certificate_file, key=own.key_file)


@pytest.mark.parametrize("host", ["127.0.0.1", "127.1.2.3", "localhost", "[::1]"])
def test_a_scheduler_of_this_host_needs_no_certificates(host: str) -> None:
    require_guarded(f"tcp://{host}:8786", None)


@pytest.mark.parametrize(
    "host", ["10.0.0.7", "scheduler.plant.example", "192.0.2.10", "[2001:db8::1]", "127.0.0.1.x.example"]
)
def test_a_scheduler_elsewhere_is_refused_in_clear(tls: DaskTls, host: str) -> None:
    for files in (None, tls):
        with pytest.raises(SchedulerAddressError) as refusal:
            require_guarded(f"tcp://{host}:8786", files)
        for word in ("expected tls://", "--tls-ca-file", "[dask] with ca, certificate and key"):
            assert word in str(refusal.value)


def test_a_scheduler_elsewhere_is_used_with_certificates(tls: DaskTls) -> None:
    require_guarded("tls://scheduler.plant.example:8786", tls)


@pytest.mark.parametrize("host", ["scheduler.plant.example", "127.0.0.1"])
def test_without_certificates_tls_is_refused_with_what_to_do(host: str) -> None:
    with pytest.raises(
        SchedulerAddressError, match=r"expected the table \[dask\] with ca, certificate and key"
    ):
        require_guarded(f"tls://{host}:8786", None)


@pytest.mark.parametrize(
    "address",
    [
        "scheduler:8786", "127.0.0.1:8786", "ws://127.0.0.1:8786", "inproc://127.0.0.1:8786", "tcp://127.0.0.1",
        "tcp://:8786", "tcp://127.0.0.1:port", "tcp://me@127.0.0.1:8786", "tcp://127.0.0.1:8786/path",
        "tcp://127.0.0.1:8786@10.0.0.7:8786", "tcp://[::1:8786", "",
    ],
)  # fmt: skip
def test_what_is_no_such_address_is_refused(address: str) -> None:
    with pytest.raises(SchedulerAddressError, match="expected tls://"):
        require_guarded(address, None)


def test_a_file_that_is_missing_or_open_to_others_is_named(tls: DaskTls) -> None:
    tls.key.chmod(0o644)
    with pytest.raises(SchedulerAddressError, match=rf"dask: {tls.key}"):
        require_guarded("tls://scheduler.plant.example:8786", tls)
    tls.key.chmod(0o600)
    tls.ca.unlink()
    with pytest.raises(SchedulerAddressError, match=rf"dask: {tls.ca}"):
        require_guarded("tls://scheduler.plant.example:8786", tls)


def test_its_files_are_meant_from_the_settings_folder(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('[dask]\nca = "ca.pem"\ncertificate = "mcc.pem"\nkey = "keys/mcc.key"\n')
    dask = Settings.load(config).dask
    assert dask == DaskTls(
        ca=tmp_path / "ca.pem", certificate=tmp_path / "mcc.pem", key=tmp_path / "keys/mcc.key"
    )


def test_a_file_that_is_not_named_is_missed(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('[dask]\nca = "ca.pem"\ncertificate = "mcc.pem"\n')
    with pytest.raises(SettingsError, match="key"):
        Settings.load(config)
