"""The causes of what is wrong with a calibration, told in reading order.

``list_findings`` is the entry: it lists each ``finding``, the most harmful first. ``cause_choice``
chooses the one cause of residuals that are not noise; among the causes are ``mixed_views`` and a
``rival_lens``. ``side_by_side`` and ``input_errors`` look at what the calibration was given, and
``harm`` says how many pixels a cause costs.
"""
