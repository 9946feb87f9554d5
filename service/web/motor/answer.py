"""The one answer of a motor on its page."""

from dataclasses import dataclass

from service.client.classification import AnswerShown, answer_shown
from service.storage import Repository


@dataclass(frozen=True, slots=True)
class AnswerSection:
    """What the page says. records: number of the latest records that took part."""

    shown: AnswerShown
    records: int


def answer_section(repository: Repository, motor: str) -> AnswerSection:
    """Read what the page says of a motor's causes. Raises NotFoundError."""
    answer = repository.motor_answer(motor)
    return AnswerSection(answer_shown(answer.classification.as_dict()), answer.records)
