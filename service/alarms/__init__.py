"""What alarms there are, and the rules by which they are raised and are over: pure logic."""
