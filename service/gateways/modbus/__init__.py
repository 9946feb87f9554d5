"""A Modbus TCP server that tells the state of the motors in registers."""
