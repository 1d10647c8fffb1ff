"""The Python face: a calibration in one call, in scripts and notebooks.

It stands beside the window and the command line, and does what they do: photographs are searched,
the best camera is found and judged, and files of other programs are read and written. Its names are
offered by the package ``calibgui`` itself. Whoever has arrays and wants arrays takes
``calibgui.engine``.
"""
