"""Names as relays of several countries write them, in the code page of their engineers' computers."""

import pytest

from core.recordings.code_pages import decode_text

TEXTS = {
    "utf-8": ["Estação de Medição,Relé", "母线保护", "ЗНМТ-1 пуск", "plain"],
    "latin-1": [
        "Estação de Medição,Oscilógrafo",
        "Unterstation Süd,Über-Strom",
        "10 µA, 20 °C",
        "Nº 4, Sección",
    ],
    "cp1251": [
        "Шины 110 кВ,Регистратор",
        "терминал версия 101110,2000",
        "1,Ua_1СШ-110_ТН_110кВ,A,1СШ-110,kV",
    ],
    "cp866": ["СИРИУС-2-Л", "Ток фазы А,Напряжение"],
    "gbk": ["变电站,母线保护装置", "1,A相电流,A,,A", "线路1保护跳闸"],
}


@pytest.mark.parametrize(("page", "text"), [(page, text) for page, texts in TEXTS.items() for text in texts])
def test_the_code_page_is_told_by_its_letters(page: str, text: str) -> None:
    assert decode_text(text.encode(page)) == text


def test_a_byte_order_mark_is_no_text() -> None:
    assert decode_text(b"\xef\xbb\xbfPLANT") == "PLANT"


@pytest.mark.parametrize("content", [bytes(range(256)), b"\xff" * 9, b"\x81\xff, \xfe", b"A\x98\x98\x98B"])
def test_every_content_has_a_text_with_its_commas(content: bytes) -> None:
    assert decode_text(content).count(",") == content.count(b",")
