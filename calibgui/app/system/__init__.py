"""What the program needs of the machine: processes, memory, libraries and places for files."""
