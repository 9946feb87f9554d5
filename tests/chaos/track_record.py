"""Write the table of docs/evidence/track-record.md: python -m tests.chaos.track_record RESULT.json ..."""

import json
import sys
from collections.abc import Mapping
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "track-record.md"
BEGIN, END = "<!-- runs: written by tests/chaos/track_record.py -->", "<!-- end of runs -->"

HEADER = (
    "| command | relays of each profile | faults | records made | lost | doubled | other content | breaches "
    "| from the relays | made to stored: median, p95, longest | integrity |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|"
)


def row(result: Mapping[str, object]) -> str:
    """One run's line of the table."""
    profiles, faults, delays = (_figures(result[key]) for key in ("profiles", "faults", "made_to_stored_s"))
    pulled = result["pulled_bytes"]
    breaches = result["breaches"]
    assert isinstance(pulled, int)
    assert isinstance(breaches, list)
    cells = [
        f"`{result['command']}`",
        ", ".join(f"{number:g} {name}" for name, number in profiles.items()),
        f"{sum(faults.values()):g}",
        f"{result['records_made']}, {result['half_records']} more by half",
        f"{result['lost']}",
        f"{result['doubled']}",
        f"{result['falsified']}",
        f"{len(breaches)}",
        f"{pulled / 1e6:.1f} MB",
        ", ".join(f"{delays[name]:.1f} s" for name in ("median", "p95", "longest")),
        f"{result['integrity']}",
    ]
    return f"| {' | '.join(cells)} |"


def faults_in_all(results: list[Mapping[str, object]]) -> str:
    """How often each fault, over all the runs."""
    counts: dict[str, float] = {}
    for result in results:
        for kind, number in _figures(result["faults"]).items():
            counts[kind] = counts.get(kind, 0) + number
    told = ", ".join(
        f"{kind} {number:g}" for kind, number in sorted(counts.items(), key=lambda each: -each[1])
    )
    return f"Faults of these runs together: {told}."


def rewrite(page: str, results: list[Mapping[str, object]]) -> str:
    """The page with the table of these runs in place of the one it has. Raises ValueError without a place."""
    before, _, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise ValueError(f"expected {BEGIN} and {END}")
    table = "\n".join([HEADER, *(row(result) for result in results)])
    return f"{before}{BEGIN}\n\n{table}\n\n{faults_in_all(results)}\n\n{END}{after}"


def _figures(value: object) -> dict[str, float]:
    assert isinstance(value, dict)
    return {str(name): float(number) for name, number in value.items()}


if __name__ == "__main__":
    given = [json.loads(Path(name).read_text(encoding="utf-8")) for name in sys.argv[1:]]
    PAGE.write_text(rewrite(PAGE.read_text(encoding="utf-8"), given), encoding="utf-8")
