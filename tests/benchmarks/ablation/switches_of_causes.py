"""What can be switched off of assessment: every cause, every test, one by one."""

from __future__ import annotations

from tests.benchmarks.ablation.rules import list_rules

ASSESSMENT = list_rules(["assessment"])
