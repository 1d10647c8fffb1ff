"""The patterns on a flat target: what is printed, where its points are, and how they are found.

`pattern` says what every pattern can do and holds the checkerboard, `charuco` and `circles` the
others, `kinds` their table. A ``Target`` (``engine/types``) is a pattern of a size.
"""
