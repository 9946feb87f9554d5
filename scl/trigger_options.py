"""What makes a report or a log entry (IEC 61850-6): the options of attributes and of control blocks."""

from lxml import etree

from scl.data_model import TriggerOptions
from scl.document import Document


def trigger_options(
    document: Document, element: etree._Element | None, *, general_interrogation: bool
) -> TriggerOptions:
    """Read dchg, qchg, dupd, period and gi of a DA or TrgOps element.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element or None
        The element; None has the defaults.
    general_interrogation : bool
        Whether to read gi, which is set by default in TrgOps.

    Returns
    -------
    TriggerOptions
        The options.
    """
    options = 0
    for attribute, option in (
        ("dchg", TriggerOptions.DATA_CHANGE),
        ("qchg", TriggerOptions.QUALITY_CHANGE),
        ("dupd", TriggerOptions.DATA_UPDATE),
        ("period", TriggerOptions.INTEGRITY),
    ):
        if document.boolean(element, attribute):
            options |= option.value
    if general_interrogation and document.boolean(element, "gi", default=True):
        options |= TriggerOptions.GENERAL_INTERROGATION.value
    return TriggerOptions(options)
