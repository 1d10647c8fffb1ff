"""From corners to a result: the calibration itself, and what is tried beside it."""
