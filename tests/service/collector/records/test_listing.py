"""A relay's directory listing, friendly and hostile."""

from dataclasses import dataclass

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from service.collector.records.listing import FolderListing, Listing, files_by_name, understand


@dataclass(frozen=True)
class Entry:
    name: str
    size: int = 100
    modified_ns: int = 5


def listed(*names: str) -> list[Entry]:
    return [Entry(name) for name in names]


def understood(entries: list[Entry], directory: str = "EVENTS") -> Listing:
    return understand([FolderListing(directory, entries)])


def test_two_folders_are_read_as_one() -> None:
    events = FolderListing("EVENTS", listed("EVENTS/HR_1.CFG", "EVENTS/HR_1.DAT"))
    comtrade = FolderListing("COMTRADE", listed("HR_1.CFG", "HR_1.DAT", "HR_2.CFG", "HR_2.DAT"))
    listing = understand([events, comtrade])
    assert [(record.directory, record.name) for record in listing.records] == [
        ("EVENTS", "HR_1"),
        ("COMTRADE", "HR_2"),
    ]
    assert [(file.name, file.reason) for file in listing.ignored] == [
        ("HR_1.CFG, HR_1.DAT", "in COMTRADE with the same sizes and times as in EVENTS")
    ]
    assert set(files_by_name([events, comtrade])) == {
        *("EVENTS/HR_1.CFG", "EVENTS/HR_1.DAT"),
        *(f"COMTRADE/HR_{number}.{suffix}" for number in (1, 2) for suffix in ("CFG", "DAT")),
    }


def test_the_files_of_a_record_are_one_record() -> None:
    listing = understood(listed("HR_1.CFG", "HR_1.DAT", "HR_1.HDR", "HR_2.cfg", "HR_2.dat"))
    assert [record.name for record in listing.records] == ["HR_1", "HR_2"]
    assert [len(record.files) for record in listing.records] == [3, 2]
    assert all(record.missing == () for record in listing.records)
    assert listing.refused == ()


def test_an_event_report_named_as_a_text_is_kept_as_an_event_report() -> None:
    listing = understood(listed("C8_10001.TXT", "EVENTS/CR_10002.txt", "SET_ALL.TXT"))
    files = [record.files[0] for record in listing.records]
    assert [file.local_name for file in files] == ["C8_10001.CEV", "CR_10002.CEV"]
    assert [file.remote_name for file in files] == ["EVENTS/C8_10001.TXT", "EVENTS/CR_10002.txt"]
    assert [file.name for file in listing.ignored] == ["SET_ALL.TXT"]


def test_size_and_time_are_those_of_the_whole_record() -> None:
    (record,) = understood([Entry("X.CFG", 10, 7), Entry("X.DAT", 1000, 9)]).records
    assert (record.size_bytes, record.modified_ns) == (1010, 9)


@pytest.mark.parametrize(
    ("listed_name", "asked_for"),
    [
        ("X.CFG", "EVENTS/X.CFG"),
        ("EVENTS/X.CFG", "EVENTS/X.CFG"),
        ("EVENTS\\X.CFG", "EVENTS\\X.CFG"),
        ("/EVENTS/X.CFG", "/EVENTS/X.CFG"),
    ],
)
def test_names_come_with_or_without_their_path(listed_name: str, asked_for: str) -> None:
    (record,) = understood([Entry(listed_name)]).records
    assert record.files[0].remote_name == asked_for
    assert record.files[0].local_name == "X.CFG"


@pytest.mark.parametrize(
    "name",
    [
        "../../etc/X.CFG",
        "..\\..\\X.CFG",
        "SETTINGS/X.CFG",
        "EVENTS/../X.CFG",
        "EVENTS/.CFG",
        ".hidden.CFG",
        "X\x00.CFG",
        "X\n.CFG",
        "X\u202e.CFG",
        'X".CFG',
        "X" * 200 + ".CFG",
    ],
)
def test_hostile_names_are_refused_and_safe_to_print(name: str) -> None:
    listing = understood([Entry(name), *listed("GOOD.CFG", "GOOD.DAT")])
    assert [record.name for record in listing.records] == ["GOOD"]
    (refused,) = listing.refused
    assert refused.reason
    assert refused.name.isprintable()


def test_two_files_that_claim_one_name_do_not_overwrite_each_other() -> None:
    listing = understood([Entry("X.CFG", 1), Entry("x.cfg", 2), Entry("X.DAT", 3)])
    (record,) = listing.records
    assert [file.size for file in record.files] == [1, 3]
    assert "two files" in listing.refused[0].reason


def test_other_files_are_ignored_and_said_to_be() -> None:
    listing = understood(listed("HISTORY.TXT", "SUBFOLDER/", "a\x1b[2J.txt"))
    assert (listing.records, listing.refused) == ((), ())
    assert {file.name: file.reason.partition(":")[0].partition(" (")[0] for file in listing.ignored} == {
        "HISTORY.TXT": "no file of a recording",
        "SUBFOLDER/": "a folder",
        "'a\\x1b[2J.txt'": "no file of a recording",
    }
    many = understood(listed(*(f"{number}.TXT" for number in range(500))))
    assert (len(many.ignored), many.ignored_in_all) == (100, 500)


def test_a_record_tells_what_it_lacks() -> None:
    (record,) = understood(listed("X.CFG", "X.HDR")).records
    assert record.missing == (".DAT",)


names = st.text(max_size=120) | st.lists(
    st.sampled_from(["..", ".", "EVENTS", "X.CFG", "/", "\\", "\0", "C:", "x.dat", " ", ".CFG"]), max_size=8
).map("".join)


@given(st.lists(names, max_size=6))
@example(["EVENTS//0.CFF"])  # a doubled slash leads to the same folder
def test_no_name_leads_out_of_the_directory(listed_names: list[str]) -> None:
    listing = understood(listed(*listed_names))
    for record in listing.records:
        for file in record.files:
            *folders, _ = file.remote_name.replace("\\", "/").split("/")
            assert [folder for folder in folders if folder] in (["EVENTS"], [])
            assert not {"/", "\\", "\0"} & set(file.local_name)
            assert file.local_name not in (".", "..")
    assert all(refused.name.isprintable() for refused in listing.refused)
