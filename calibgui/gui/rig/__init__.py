"""The page of a rig: several cameras that photograph one board together."""
