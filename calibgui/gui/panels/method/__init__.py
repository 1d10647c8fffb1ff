"""The panels of the group Method: how the camera was found, and what else could be."""
