"""Reports about a calibration as sentences, tables, figures and pages; they need no display.

Sentences: ``summary``, ``advice``, ``partial``, ``boards``. Tables as text: ``tables``,
``quality``. Figures by matplotlib: ``figures``, ``quality_figures``; the scene of boards and camera
as polygons: ``scene3d``. The paper's figures and numbers beside ours: ``paper_figures``,
``paper_page``, ``printed_values``. Numbers and names as people read them: ``numbers``, ``names``.
"""
