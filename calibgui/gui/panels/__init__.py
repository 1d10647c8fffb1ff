"""The right of the window: one panel for each aspect of a result."""
