"""An IEC 60870-5-104 server that tells the health of the motors."""
