"""Names become levels of topics that mean nothing else, and stay apart."""

from urllib.parse import unquote

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.configuration.gateways.mqtt import MqttSettings
from service.gateways.mqtt.topics import level


@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=50))
def test_a_name_comes_back_from_its_level(name: str) -> None:
    found = level(name)
    assert unquote(found) == name
    assert not set(found) & set("/+#\0")


def test_letters_of_all_languages_stay() -> None:
    assert level("Pumpe Süd/3 +10 #1 100%") == "Pumpe Süd%2F3 %2B10 %231 100%25"
    assert level("泵\u0000\ud800") == "泵%00%ED%A0%80"


@pytest.mark.parametrize(
    ("table", "problem"),
    [
        ({"prefix": "$SYS"}, "levels of a topic"),
        ({"prefix": "a//b"}, "levels of a topic"),
        ({"prefix": "a/+"}, "levels of a topic"),
        ({"sparkplug": {"group": "a/b"}}, "a name without"),
        (
            {"host": "broker.plant.example", "tls": False, "user": "a", "password_file": "p"},
            "tls, where a password",
        ),
        ({"password_file": "p"}, "user, where"),
        ({"ca": "ca.pem"}, "only with tls"),
        ({"tls": True, "key": "key.pem"}, "certificate and key together"),
    ],
)
def test_settings_that_cannot_work_are_refused(table: dict[str, object], problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        MqttSettings.model_validate(table)


def test_what_leaves_the_machine_is_encrypted() -> None:
    assert not MqttSettings().uses_tls
    other = MqttSettings(host="broker.plant.example")
    assert (other.uses_tls, other.broker_port) == (True, 8883)
