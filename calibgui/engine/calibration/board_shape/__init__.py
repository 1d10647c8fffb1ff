"""The board's shape: its deviations from the drawing, and what they do to the camera."""
