"""How fast a level grows, and when it reaches a limit."""
