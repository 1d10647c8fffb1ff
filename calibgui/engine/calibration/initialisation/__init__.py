"""The start of Stage II from corners: Stage I, one camera in closed form, and all poses."""
