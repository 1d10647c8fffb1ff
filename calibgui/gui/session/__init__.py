"""No place of its own: the document that all parts share, and what searches, solves and saves."""
