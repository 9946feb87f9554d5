"""The catalogue of figures: each is declared once, with its name, unit, meaning and subject."""

from core.quantities.catalogue import BY_NAME, QUANTITIES, TRENDED, TrendedName, beside, of_subject
from core.quantities.quantity import Quantity, Role, Subject

__all__ = [
    "BY_NAME",
    "QUANTITIES",
    "TRENDED",
    "Quantity",
    "Role",
    "Subject",
    "TrendedName",
    "beside",
    "of_subject",
]
