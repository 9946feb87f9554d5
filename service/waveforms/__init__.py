"""What stored recordings hold, for the eye: windows of samples, phasors, spectra, the model's currents."""
