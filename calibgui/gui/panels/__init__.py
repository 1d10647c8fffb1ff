"""Views of a result: one file, one widget, one setter each."""
