"""An OPC UA server that tells the health of motors and relays."""
