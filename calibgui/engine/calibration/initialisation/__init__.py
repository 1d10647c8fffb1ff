"""From corners to a start of Stage II: Stage I, one camera in closed form, and all poses."""
