"""The causes of what is wrong with a calibration, told in reading order.

``findings`` is the entry: it lists what is wrong, the most harmful first. ``cause_choice``
chooses the one cause of residuals that are not noise; among the causes are ``mixed_views`` and a
``rival_lens``. ``two_pictures``, ``odd_views`` and ``input_errors`` look at what the calibration
was given, and ``case`` says how many pixels a cause costs.
"""
