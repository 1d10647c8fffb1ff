"""The way from corners to a result: calibrations, and the comparisons and checks beside them."""
