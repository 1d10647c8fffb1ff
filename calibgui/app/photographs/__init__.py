"""Photographs of a board: which files are meant, their pixels, and the corners found in them."""
