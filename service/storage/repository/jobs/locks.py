"""What is locked before a job is."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.storage.models import JobRow, MotorRow, RecordingRow


def lock_motor_of(session: Session, job_id: str) -> None:
    """Have one job of a motor finished at a time: what a record says of the rotor rests on its neighbours.

    The motor comes before the job, as for whoever deletes a recording: no two wait for each other.
    """
    of_job = (
        select(MotorRow)
        .join(RecordingRow, RecordingRow.motor == MotorRow.name)
        .join(JobRow, JobRow.recording_id == RecordingRow.id)
        .where(JobRow.id == job_id)
    )
    session.scalars(of_job.with_for_update(of=MotorRow, key_share=True)).first()
