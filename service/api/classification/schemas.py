"""Documents of the one answer. Fields that are null are not known."""

from service.api.document import Document, Listed


class Likelihood(Document):
    """How likely one cause is, alone or with another.

    log_likelihood_ratio: log of the likelihood of all figures with this cause alone, over that of a healthy
    motor; null where nothing is known of it, and `figure` then says why.
    """

    cause: str
    probability: float
    log_likelihood_ratio: float | None
    figure: str


class Explanation(Document):
    """Causes that together explain all that is measured, "healthy" for none."""

    causes: Listed[str]
    probability: float


class NotToldApart(Document):
    """Two explanations that are left open, and the records or tests that would tell, the easiest first."""

    explanations: Listed[Listed[str]]
    tests: Listed[str]


class Classification(Document):
    """The one answer of a record or of a motor.

    answer: the likeliest causes. is_told: whether they are likely enough to be the answer alone. words: the
    answer as people read it. The verdict is what raises alarms; where it differs, `reasons` say so.
    """

    answer: Listed[str]
    is_told: bool
    probability: float
    words: str
    likelihoods: Listed[Likelihood]
    explanations: Listed[Explanation]
    not_told_apart: Listed[NotToldApart]
    reasons: Listed[str]


class MotorClassification(Classification):
    """The one answer of a motor. records: number of its latest records that took part."""

    motor: str
    records: int
