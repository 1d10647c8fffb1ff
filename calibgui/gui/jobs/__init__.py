"""No place of its own: work beside the main thread, whose progress the status bar shows."""
