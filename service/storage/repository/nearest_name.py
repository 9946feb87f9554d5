"""The name that somebody meant who asked for one that there is not."""

from sqlalchemy import func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from core.error_words import nearest

MOST_COMPARED = 500
"""With so many names one that is misspelt is compared, the first by the alphabet: an answer stays quick."""


def nearest_name(session: Session, column: InstrumentedAttribute[str], name: str) -> str | None:
    """Return the name in a column that is most like another one; None where none is.

    One that differs by capitals only is found among any number of names.
    """
    alike = session.scalars(select(column).where(func.lower(column) == func.lower(name)).limit(1)).first()
    if alike is not None:
        return alike
    return nearest(name, session.scalars(select(column).order_by(column).limit(MOST_COMPARED)))
