"""Tables, figures and pages about a calibration: text and matplotlib, no display needed."""
