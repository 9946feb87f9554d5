"""How often the cause of another start is told rightly."""
