"""The verdict on the shown result, always in sight, and buttons that do what makes it better."""
