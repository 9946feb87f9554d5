from service.web import words

DAY_NS = 86_400_000_000_000


def test_ages() -> None:
    assert words.age(None, 0) == "never"
    assert words.age(0, 3 * DAY_NS) == "3 days ago"
    assert words.age(3 * DAY_NS, 0) == "in 3 days"


def test_what_is_not_known_has_a_dash_of_its_own() -> None:
    assert {words.percent(None), words.interval(None), words.figure(float("nan")), words.utc(None)} == {"–"}


def test_figures() -> None:
    assert words.percent(0.05126) == "5.13 %"
    assert words.percent(-0.001) == "−0.10 %"
    assert words.interval((0.042, 0.06)) == "4.20 to 6.00 %"
    assert words.figure(0.0012345, "A") == "0.00123 A"
    assert words.figure(123456.0, "W") == "123456 W"
    assert words.size(1_234_567) == "1.23 MB"
