"""Recordings: the list, bringing one, and one of them with its waveforms, phasors, spectrum and diagnosis."""
