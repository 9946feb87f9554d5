from tests.docs import quantities


def test_the_page_has_the_figures_of_the_catalogue() -> None:
    assert quantities.PAGE.read_text(encoding="utf-8") == quantities.page(), "make docs"
