"""What several panels are made of: maps, arrows, tables, and places side by side."""
