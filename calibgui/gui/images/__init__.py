"""The film strip at the bottom: thumbnails, what was found in each, and how well it fits."""
