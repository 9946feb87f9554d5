"""Marks of visits: where they are kept. What they are for is tested with the blame after a crash."""

from pathlib import Path

from service.collector.session.visit_marks import VisitMarks


def test_a_relay_whose_name_is_a_path_is_marked_inside(tmp_path: Path) -> None:
    marks = VisitMarks(tmp_path / "marks")
    with marks.mark("../../X"):
        assert marks.suspects() == {"../../X"}
        assert [path.name for path in tmp_path.iterdir()] == ["marks"]
    assert marks.suspects() == frozenset()
