"""What is locked before a job is."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.storage.models import JobRow, MotorRow, RecordingRow
from service.storage.repository.sessions import found


def lock_motor_of(session: Session, job_id: str) -> None:
    """Have one job of a motor finished at a time: what a record says of the rotor rests on its neighbours.

    The motor comes before the job, as for whoever deletes a recording: no two wait for each other.
    """
    of_job = select(RecordingRow.motor).join(JobRow, JobRow.recording_id == RecordingRow.id)
    motor = session.scalar(of_job.where(JobRow.id == job_id))
    if motor is not None:
        found(session, MotorRow, motor, "motor", lock=True)
