"""The tabs below the list of images: the board, and how to calibrate."""
