"""The panels of the group Evidence: what the views say for and against the camera."""
