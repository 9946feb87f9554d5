"""What one record tells of the motor, as the filter measures it."""
