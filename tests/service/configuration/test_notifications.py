"""The table [notifications]: what is wrong is told with its line, the nearest name, and no secret."""

from pathlib import Path

import pytest

from service.configuration.channel_secrets import ChannelSecretError, signing_key, url
from service.configuration.channels import WebhookChannel
from service.configuration.problems import Problems
from service.configuration.settings import Settings

MAIL = """[notifications.channels.ops]
kind = "mail"
host = "mail.plant.example"
from = "mcc@plant.example"
to = ["shift@plant.example"]
"""


def problems(tmp_path: Path, text: str) -> list[str]:
    config = tmp_path / "mcc.toml"
    config.write_text(text)
    found = Problems()
    Settings.examine(config, found)
    return [str(problem).removeprefix(f"{config}: ") for problem in found]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            MAIL + 'hots = "x"\n',
            "line 6: notifications.channels.ops.hots: expected a setting named in "
            "docs/reference/settings.md, found another name (did you mean host?)",
        ),
        (
            '[notifications.channels.ops]\nkind = "mial"\n',
            "line 2: notifications.channels.ops.kind: expected one of mail, webhook, syslog, command, "
            "apprise, found 'mial' (did you mean mail?)",
        ),
        (
            '[notifications.channels.ops]\nhost = "x"\n',
            "line 1: notifications.channels.ops.kind: expected the key kind, which says of which kind the "
            "table is, found none",
        ),
        (
            MAIL.replace('"]', '\\nBcc: x@evil.example"]'),
            "line 5: notifications.channels.ops.to.0: expected a mail address such as shift@plant.example, "
            "without a name and in ASCII, found 'shift@plant.example\\nBcc: x@evil.example'",
        ),
        (
            '[notifications.channels.x]\nkind = "webhook"\nurl = "https://user:pw@host/"\n',
            "line 3: notifications.channels.x.url: expected an address such as "
            "https://chat.plant.example/hook, without a password, found another text",
        ),
        (
            '[notifications.channels.x]\nkind = "command"\ncommand = ["page"]\n',
            "line 3: notifications.channels.x.command: expected a list of words that begins with the path of "
            'a program, such as ["/opt/page", "-v"], found [\'page\']',
        ),
        (
            MAIL + '[[notifications.routes]]\nchannels = ["opps"]\n',
            "line 1: notifications: expected in routes.0 channels that [notifications.channels.NAME] defines "
            "(ops), found 'opps' (did you mean ops?)",
        ),
        (
            MAIL + '[[notifications.routes]]\nchannels = ["ops"]\nfrom = "18.00"\n',
            "line 8: notifications.routes.0.from: expected a time of day such as \"18:00\", found '18.00'",
        ),
        (
            MAIL + '[[notifications.routes]]\nchannels = ["ops"]\nescalation = []\n',
            "line 8: notifications.routes.0.escalation: expected a setting named in "
            "docs/reference/settings.md, found another name (did you mean escalations?)",
        ),
        (
            '[notifications]\ntime_zone = "Berlin"\n',
            "line 2: notifications.time_zone: expected a time zone of the IANA such as Europe/Berlin (did "
            "you mean Europe/Berlin?), found 'Berlin'",
        ),
        (
            MAIL + MAIL.replace("ops", "OPS"),
            "line 1: notifications: expected channels whose names differ by more than capitals and dashes, "
            "found ops and OPS",
        ),
    ],
)
def test_what_is_wrong_is_told_where_it_is(tmp_path: Path, text: str, told: str) -> None:
    assert problems(tmp_path, text) == [told]


def test_paths_start_at_the_folder_of_the_settings(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(MAIL + 'password_file = "secrets/mail"\nca = "/etc/ca.pem"\n')
    channel = Settings.load(config).notifications.channels["ops"]
    assert channel.model_dump()["password_file"] == tmp_path / "secrets" / "mail"
    assert channel.model_dump()["ca"] == Path("/etc/ca.pem")


def test_times_of_day_may_be_those_of_toml(tmp_path: Path) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text(
        MAIL + '[[notifications.routes]]\nchannels = ["ops"]\nfrom = 18:00:00\nuntil = "06:30"\n'
    )
    (route,) = Settings.load(config).notifications.routes
    assert (route.begin.hour, route.end.minute) == (18, 30)


def test_secrets_are_read_from_files_that_nobody_else_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = tmp_path / "url"
    secret.touch(mode=0o600)
    channel = WebhookChannel.model_validate({"kind": "webhook", "url_file": secret, "secret_file": secret})
    secret.write_text("not an address\n")
    with pytest.raises(ChannelSecretError, match="expected an address") as wrong:
        url("chat", channel)
    assert "not an address" not in str(wrong.value)
    secret.write_text("https://chat.example/x\nanother line\n")
    with pytest.raises(ChannelSecretError, match="a secret on one line"):
        url("chat", channel)
    monkeypatch.setenv("MCC_NOTIFY_SECRET_CHAT", "whsec_no base64!")
    with pytest.raises(ChannelSecretError, match="a key in base64") as no_key:
        signing_key("chat", channel)
    assert "no base64" not in str(no_key.value)
    secret.chmod(0o640)
    with pytest.raises(ChannelSecretError, match="chat"):
        url("chat", channel)


def test_a_variable_of_a_secret_is_no_unknown_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MCC_NOTIFY_PASSWORD_OPS", "secret")
    assert problems(tmp_path, MAIL) == []
    monkeypatch.setenv("MCC_NOTIFY_PASSWRD_OPS", "secret")
    (told,) = problems(tmp_path, MAIL)
    assert "MCC_NOTIFY_PASSWRD_OPS" in told
    assert "secret" not in told
