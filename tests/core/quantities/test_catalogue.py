from collections import Counter
from dataclasses import fields

import pytest

from core.losses.figures import LossFigures
from core.quantities import BY_NAME, QUANTITIES, TRENDED, Role, Subject, beside, of_subject
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.supply.figures import SupplyFigures

FINDINGS = {
    Subject.ROTOR: RotorFinding,
    Subject.AIR_GAP: EccentricityFinding,
    Subject.LOAD: PulsationFinding,
    Subject.SUPPLY: SupplyFigures,
    Subject.LOSSES: LossFigures,
}


def test_each_figure_is_declared_once() -> None:
    assert [name for name, number in Counter(one.name for one in QUANTITIES).items() if number > 1] == []
    places = Counter((one.subject, one.attribute) for one in QUANTITIES)
    assert [place for place, number in places.items() if number > 1] == []


@pytest.mark.parametrize("subject", FINDINGS)
def test_each_stands_in_the_finding_of_its_subject(subject: Subject) -> None:
    names = {field.name for field in fields(FINDINGS[subject])}
    for one in of_subject(subject):
        assert one.attribute.removesuffix("_low").removesuffix("_high") in names, one.name


def test_what_belongs_to_a_figure_names_one_of_the_same_subject_and_unit() -> None:
    beside_others = [one for one in QUANTITIES if one.of is not None]
    assert len(beside_others) > 10
    for one in beside_others:
        assert one.of is not None
        value = BY_NAME[one.of]
        assert (value.role, value.subject, value.unit) == (Role.VALUE, one.subject, one.unit)
        assert one.role is not Role.VALUE


def test_words_and_what_stands_beside_a_figure_have_no_trend() -> None:
    assert {"verdict", "state", "mu_f_ci95_low", "swing_detection_limit"}.isdisjoint(TRENDED)
    assert {"mu_f", "change", "slip", "thd_voltage", "stator_resistance_change"} <= set(TRENDED)


def test_the_level_has_interval_scatter_and_limit() -> None:
    assert {role: one.name for role, one in beside("mu_f").items()} == {
        Role.CI95_LOW: "mu_f_ci95_low",
        Role.CI95_HIGH: "mu_f_ci95_high",
        Role.SCATTER95_LOW: "mu_f_scatter95_low",
        Role.SCATTER95_HIGH: "mu_f_scatter95_high",
        Role.DETECTION_LIMIT: "detection_limit",
    }
    assert beside("power_factor") == {}
