"""What people found when they inspected motors, and how often the service was right."""
