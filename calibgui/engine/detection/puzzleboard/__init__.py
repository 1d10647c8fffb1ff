"""The detector of PuzzleBoards: a checkerboard's corners, then the dots that tell their place."""
