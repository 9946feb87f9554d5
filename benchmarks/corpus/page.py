"""What a corpus run found, as Markdown and as one JSON document."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from benchmarks.corpus.kinds import KINDS, Found
from benchmarks.corpus.outcomes import Agreement, Examined, Reading, Service, alike, shortened
from benchmarks.reporting import table

MOST_ORPHANS = 10
MOST_REASONS = 40
"""Rows of a table of reasons; what is rarer is counted together."""


def document(folder: str, found: Found, files: Sequence[Examined]) -> dict[str, object]:
    """The whole run: counts of each kind, and every file."""
    return {
        "folder": folder,
        "kinds": {kind.name: _counts(_of_kind(files, kind.name)) for kind in KINDS},
        "parts": found.parts,
        "orphans": [shortened(str(path)) for path in found.orphans],
        "others": found.others,
        "unreadable_folders": list(found.unreadable),
        "files": [
            {
                "file": one.path,
                "kind": one.kind,
                "reading": str(one.outcome.reading),
                "notes": list(one.outcome.notes),
                "agreement": str(one.comparison.agreement),
                "differences": list(one.comparison.notes),
                "seconds": round(one.seconds, 4),
                "served": [
                    {"relay": each.relay, "service": str(each.service), "notes": list(each.notes)}
                    for each in one.served
                ],
            }
            for one in files
        ],
    }


def markdown(found: Found, files: Sequence[Examined]) -> str:
    """Tables: how many of each kind were read how, what the other readers say, and all reasons."""
    lines = ["How the files were read:", ""]
    kinds = [kind for kind in KINDS if _of_kind(files, kind.name)]
    lines += table(
        ["Kind", "Files", *map(str, Reading)],
        [
            [kind.name, str(len(_of_kind(files, kind.name))), *_cells(_of_kind(files, kind.name), Reading)]
            for kind in kinds
        ],
    )
    compared = [kind for kind in kinds if kind.compare is not None]
    if compared:
        lines += ["", "Beside other readers:", ""]
        lines += table(
            ["Kind", "Other reader", *map(str, Agreement)],
            [[kind.name, kind.peer, *_agreements(_of_kind(files, kind.name))] for kind in compared],
        )
    relays = Counter(each.service for one in files for each in one.served)
    if relays:
        lines += ["", "Relays of these files with a server, served by ied-sim:", ""]
        lines += table(
            ["Relays", *map(str, Service)],
            [[str(relays.total()), *(str(relays[service]) for service in Service)]],
        )
    lines += [
        "",
        f"Beside these there are {found.parts} files that belong to them and {found.others} of other kinds.",
    ]
    if found.orphans:
        names = ", ".join(shortened(path.name) for path in found.orphans[:MOST_ORPHANS])
        more = ", ..." if len(found.orphans) > MOST_ORPHANS else ""
        lines.append(f"{len(found.orphans)} are of recordings without a configuration: {_cell(names)}{more}.")
    lines += [f"Not listed: {folder}" for folder in found.unreadable]
    for reading in (Reading.CRASHED, Reading.REFUSED, Reading.LENIENT, Reading.WARNED):
        here = [one for one in files if one.outcome.reading is reading]
        if here:
            notes = ((one, note) for one in here for note in one.outcome.notes)
            lines += ["", f"{str(reading).capitalize()}:", "", *_reasons(notes, "Reason, of the first file")]
    for agreement in (Agreement.DIFFERS, Agreement.PEER_FAILS, Agreement.EXPLAINED):
        here = [one for one in files if one.comparison.agreement is agreement]
        if here:
            notes = ((one, note) for one in here for note in one.comparison.notes)
            title = f"{str(agreement).capitalize()}:"
            lines += ["", title, "", *_reasons(notes, "What is said, of the first file")]
    for service in (Service.CRASHED, Service.NOT_SERVED, Service.IN_PART, Service.NOT_TRIED):
        told = [
            (one, note)
            for one in files
            for each in one.served
            for note in each.notes
            if each.service is service
        ]
        if told:
            title = f"{str(service).capitalize()}:"
            lines += ["", title, "", *_reasons(told, "What is said, of the first relay", "Relays")]
    return "\n".join(lines) + "\n"


def _of_kind(files: Sequence[Examined], name: str) -> list[Examined]:
    return [one for one in files if one.kind == name]


def _counts(files: Sequence[Examined]) -> dict[str, object]:
    return {
        "files": len(files),
        "readings": dict(Counter(str(one.outcome.reading) for one in files)),
        "agreements": dict(Counter(str(one.comparison.agreement) for one in files)),
        "relays": dict(Counter(str(each.service) for one in files for each in one.served)),
    }


def _cells(files: Sequence[Examined], readings: Iterable[Reading]) -> Iterator[str]:
    counts = Counter(one.outcome.reading for one in files)
    return (str(counts[reading]) for reading in readings)


def _agreements(files: Sequence[Examined]) -> Iterator[str]:
    counts = Counter(one.comparison.agreement for one in files)
    return (str(counts[agreement]) for agreement in Agreement)


def _reasons(notes: Iterable[tuple[Examined, str]], heading: str, counted: str = "Files") -> list[str]:
    """Count alike notes, which differ in names and figures only; the first file of each is named."""
    first: dict[str, tuple[Examined, str]] = {}
    counts: Counter[str] = Counter()
    for one, note in notes:
        pattern = _pattern(note, one.path)
        first.setdefault(pattern, (one, note))
        counts[pattern] += 1
    common = counts.most_common()
    rows = [
        [str(count), _cell(first[pattern][1]), _cell(first[pattern][0].path)]
        for pattern, count in common[:MOST_REASONS]
    ]
    if rest := common[MOST_REASONS:]:
        rows.append([str(sum(count for _, count in rest)), f"{len(rest)} more, each rarer", ""])
    return table([counted, heading, "First file"], rows)


def _pattern(note: str, path: str) -> str:
    note = note.replace(path.rsplit("/", 1)[-1], "")
    return alike(note)


def _cell(text: str) -> str:
    """Text for a cell of a Markdown table."""
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("`", "'")
