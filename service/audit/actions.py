"""What the audit trail knows of: every action that leaves an entry, in words."""

from collections.abc import Mapping
from enum import StrEnum


class AuditAction(StrEnum):
    """What was done. A test finds routes that change something without one."""

    RECORDING_REQUESTED = "recording-requested"
    RECORDING_UPLOADED = "recording-uploaded"
    RECORDING_DELETED = "recording-deleted"
    DIAGNOSIS_REQUESTED = "diagnosis-requested"
    BASELINE_SET = "baseline-set"
    BASELINE_DELETED = "baseline-deleted"
    NOTE_ADDED = "note-added"
    NOTE_WITHDRAWN = "note-withdrawn"
    REFERENCE_RESTARTED = "reference-restarted"
    QUARANTINE_RELEASED = "quarantine-released"
    PLANT_CHANGED = "plant-changed"
    PARAMETERS_CHANGED = "parameters-changed"
    RETENTION_APPLIED = "retention-applied"


MEANINGS: Mapping[AuditAction, str] = {
    AuditAction.RECORDING_REQUESTED: "Somebody had a motor recorded (`mcc trigger`).",
    AuditAction.RECORDING_UPLOADED: "Somebody gave the service a recording.",
    AuditAction.RECORDING_DELETED: "Somebody deleted a recording; `before` is what it was.",
    AuditAction.DIAGNOSIS_REQUESTED: "Somebody had a recording diagnosed again.",
    AuditAction.BASELINE_SET: "Somebody chose the healthy recordings of a motor, in place of others.",
    AuditAction.BASELINE_DELETED: "Somebody dropped a motor's baseline.",
    AuditAction.NOTE_ADDED: "Somebody wrote into a motor's logbook.",
    AuditAction.NOTE_WITHDRAWN: "Somebody let a note count no more.",
    AuditAction.REFERENCE_RESTARTED: "Somebody took a motor for healthy as it is.",
    AuditAction.QUARANTINE_RELEASED: "Somebody had a relay visited again; `before` is why it was set aside.",
    AuditAction.PLANT_CHANGED: (
        "The service started with other plant files: a site, relay or motor came (no `before`), left (no "
        "`after`) or is told otherwise."
    ),
    AuditAction.PARAMETERS_CHANGED: "The service started with other figures of a motor in its motors file.",
    AuditAction.RETENTION_APPLIED: "Rules of `[retention]` deleted what they say; how much of what.",
}
"""What each action means, for the reference page."""
