"""The panels of the group Answer: the camera, and how well it is known."""
