"""The middle of the window: the selected image, what is drawn over it, and marking by hand."""
