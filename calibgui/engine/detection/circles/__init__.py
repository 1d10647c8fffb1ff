"""The detector of grids of circles: dark parts, their grid, and an ellipse fitted to each."""
