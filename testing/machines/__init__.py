"""Motors, starts and two sets of machine equations that share no code with the models under test."""
