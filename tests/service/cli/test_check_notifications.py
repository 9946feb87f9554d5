"""`mcc check` on notifications: names that nobody has, missing secrets, alarms that call nobody."""

from pathlib import Path

import pytest

from service.application.serve import serve
from service.cli.app import main
from service.configuration.settings import Settings, SettingsError
from tests.service.cli.test_check import config

__all__ = ["config"]

CHANNELS = """
[notifications.channels.ops]
kind = "mail"
host = "mail.plant.example"
user = "mcc"
password_file = "mail-password"
from = "mcc@plant.example"
to = ["shift@plant.example"]

[notifications.channels.pager]
kind = "command"
command = ["/no/such/program"]
"""


def checked(config: Path, text: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    config.write_text(config.read_text() + text)
    main(["check", "--config", str(config)])
    return capsys.readouterr().out.splitlines()


def test_names_that_nobody_has_are_refused_with_the_nearest(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    route = '[[notifications.routes]]\nchannels = ["pager"]\nsites = ["plan"]\nkinds = ["link-dwn"]\n'
    said = checked(config, CHANNELS + route, capsys)
    wrong = "notifications.routes.0.sites: expected one of PLANT, found 'plan' (did you mean PLANT?)"
    assert any(line.endswith(wrong) for line in said)
    assert any("found 'link-dwn' (did you mean link-down?)" in line for line in said)
    with pytest.raises(SettingsError, match="did you mean link-down"):
        serve(Settings.load(config))


def test_a_report_by_mail_of_what_there_is_not_is_refused(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mail = '[[reports.mails]]\nperiod = "daily"\nat = "06:00"\nchannels = ["ops"]\n'
    fleet, motor = 'report = "fleet"\nsites = ["PLNT"]\n', 'report = "motor"\nmotors = ["NOBODY"]\n'
    said = checked(config, CHANNELS + mail + fleet + mail + motor, capsys)
    wrong = "reports.mails.0.sites: expected one of PLANT, found 'PLNT' (did you mean PLANT?)"
    assert any(line.endswith(wrong) for line in said)
    assert any("reports.mails.1.motors: expected one of" in line for line in said)
    with pytest.raises(SettingsError, match=r"reports\.mails\.1\.motors"):
        serve(Settings.load(config))


def test_what_a_channel_needs_and_has_not_is_told_without_the_secret(
    config: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = config.with_name("mail-password")
    secret.write_text("correct horse")
    secret.chmod(0o644)
    monkeypatch.setenv("MCC_NOTIFY_PASSWORD_OPPS", "correct horse")
    said = checked(config, CHANNELS, capsys)
    assert any("notifications.channels.ops" in line and "mail-password" in line for line in said), said
    assert any("notifications.channels.pager.command: expected a program" in line for line in said)
    assert any("MCC_NOTIFY_PASSWORD_OPPS: expected the name of a channel" in line for line in said)
    assert "correct horse" not in "".join(said)


@pytest.mark.parametrize(
    ("routes", "warned"),
    [
        ("", "critical alarms at PLANT, such as on mon at 00:00"),
        ('[[notifications.routes]]\nchannels = ["ops"]\n', None),
        ('[[notifications.routes]]\nchannels = ["ops"]\nsites = ["PLANT"]\n', "alarms of the service itself"),
        (
            '[[notifications.routes]]\nchannels = ["ops"]\ndays = ["mon", "tue", "wed", "thu", "fri"]\n',
            "at PLANT, such as on sat at 00:00",
        ),
        (
            '[[notifications.routes]]\nchannels = ["ops"]\nfrom = "06:00"\nuntil = "22:00"\n'
            '[[notifications.routes]]\nchannels = ["ops"]\nfrom = "22:00"\nuntil = "06:00"\n',
            None,
        ),
        (
            '[[notifications.routes]]\nchannels = ["ops"]\npriorities = ["critical"]\n',
            "nobody is told of high alarms at PLANT",
        ),
        (
            '[[notifications.routes]]\nchannels = ["ops"]\nfrom = "06:00"\nuntil = "22:00"\n'
            'outside_hours = "wait"\n',
            None,
        ),
    ],
)
def test_urgent_alarms_that_call_nobody_are_warned_of(
    config: Path, capsys: pytest.CaptureFixture[str], routes: str, warned: str | None
) -> None:
    said = [line for line in checked(config, CHANNELS + routes, capsys) if "nobody is told" in line]
    assert len(said) == (0 if warned is None else 1)
    assert warned is None or warned in said[0]
