"""How far a calibration is to be trusted, and what would make it better."""
