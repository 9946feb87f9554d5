"""The page of the alarms has the tables of the code."""

from service.alarms.catalogue import CATALOGUE
from service.alarms.kinds import AlarmKind
from tests.docs import alarm_kinds, alarm_transitions


def test_the_page_has_the_transitions_of_the_code() -> None:
    page = alarm_transitions.PAGE.read_text(encoding="utf-8")
    assert alarm_transitions.table() in page, "make docs"


def test_the_page_has_the_kinds_of_the_catalogue() -> None:
    assert alarm_kinds.table() in alarm_kinds.PAGE.read_text(encoding="utf-8"), "make docs"


def test_the_catalogue_tells_of_every_kind_one_sentence_each() -> None:
    assert set(CATALOGUE) == set(AlarmKind)
    for described in CATALOGUE.values():
        for sentence in (described.cause, described.consequence, described.action):
            assert sentence[0].isupper()
            assert sentence.endswith(".")
            assert ". " not in sentence
            assert len(sentence) < 200
