"""Fit of corners: the place of an X-corner with its covariance, on which every board rests.

In reading order: ``x_corner_model`` is the model of two crossing edges, ``x_corner_step`` a step of
its fit, ``x_corner_fit`` the fit of all corners of a board; ``board_priors`` and what it rests on
tell what a corner's neighbours say of it, and ``verification`` whether what was fitted is a board.

Lengths on the board are in squares. Unless a limit says otherwise its value is a plausibility
limit; `python -m tests.benchmarks.corners` exercises them all.
"""
