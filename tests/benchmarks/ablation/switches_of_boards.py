"""What can be switched off of the finders of other boards than checkerboards.

Every rule of their rooms, one by one; what they share with the finder of checkerboards is in its
list.
"""

from __future__ import annotations

from tests.benchmarks.ablation.rules import list_rules

CHARUCO = list_rules(["charuco", "print_samples", "printed_marks", "blurred_print"])
APRILGRID = list_rules(["apriltags", "print_samples", "blurred_print"])
PUZZLEBOARD = list_rules(["puzzleboard", "printed_marks", "blurred_print"])
CIRCLES = list_rules(["circles"])
