"""The detector of checkerboards, told in reading order.

``find_checkerboard`` is the entry. The search: ``pyramid_search`` goes through the levels of the
image; in each ``x_junctions`` finds X-junctions, ``neighbour_graph`` joins them to lattices,
``prefilter`` drops those that cannot be boards and ``lattice_growth`` extends the others. Then
``board_refinement`` makes boards of them: ``saddle`` and ``x_corner_fit`` locate the corners, and
``verification`` and ``a_contrario`` decide whether they are a board's. ``numbering`` gives them
their rows and columns. The limits that the search and the verification ask for are in
``thresholds``.
"""
