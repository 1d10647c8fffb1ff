"""Projects: what the user works on, its history, and the files that keep it."""
