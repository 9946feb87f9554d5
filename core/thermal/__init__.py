"""How hot a motor is: its relay's thermal model, a model of two bodies, and its winding's resistance."""
