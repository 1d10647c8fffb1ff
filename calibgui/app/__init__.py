"""What the command line and the window both do, free of Qt: find images, search, solve, write."""
