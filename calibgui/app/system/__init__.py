"""The machine that the program runs on: processes, memory, libraries and places for files."""
