"""What raises alarms beside the conditions of motors and the visits of relays: looked at again and again."""
