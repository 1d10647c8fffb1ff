"""The plate as it is, not as it was drawn."""
