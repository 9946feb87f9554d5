"""The others of a bus are judged anew only where a motor's standing asymmetry has really changed."""

from typing import Any

import pytest

from service.storage.repository.conditions.standing_changes import is_material

TOLD: dict[str, Any] = {
    "sequence": "abc",
    "asymmetry": [1e-3, 2e-3],
    "covariance": [[1e-8, 0.0], [0.0, 1e-8]],
    "channels": [[1e-5, 0.0], [0.0, 1e-5]],
    "others": 2,
}


@pytest.mark.parametrize(
    ("change", "material"),
    [
        ({}, False),
        ({"asymmetry": [1.01e-3, 2e-3]}, False),
        ({"asymmetry": [1.03e-3, 2e-3]}, True),
        ({"covariance": [[0.9e-8, 0.0], [0.0, 0.9e-8]]}, False),
        ({"covariance": [[0.7e-8, 0.0], [0.0, 0.9e-8]]}, True),
        ({"others": 3}, True),
        ({"sequence": "acb"}, True),
    ],
)
def test_a_change_counts_from_a_fifth_of_its_deviation(change: dict[str, Any], *, material: bool) -> None:
    assert is_material(TOLD, {**TOLD, **change}) is material


def test_the_first_estimate_and_its_end_count() -> None:
    assert is_material(None, TOLD)
    assert is_material(TOLD, None)
    assert not is_material(None, None)
