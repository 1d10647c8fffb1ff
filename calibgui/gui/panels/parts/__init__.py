"""The parts that several panels share are maps, arrows, tables, and places side by side."""
