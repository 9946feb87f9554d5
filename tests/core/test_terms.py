from core.terms import phrase


def test_a_term_in_words() -> None:
    assert phrase("shorted-turns") == "shorted turns"
    assert phrase("not_running yet") == "not running yet"
