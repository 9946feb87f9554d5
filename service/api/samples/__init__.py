"""Samples of recordings and what follows from them: states, phasors, spectra, the model's currents."""
