"""The detector of checkerboards.

``find_checkerboard`` is the entry. It searches for lattices that may be boards,
``board_refinement`` makes boards of them, and ``descriptions`` tells what was seen if none is one.
"""
