"""The list of images on the left, with their thumbnails and what was found in each."""
