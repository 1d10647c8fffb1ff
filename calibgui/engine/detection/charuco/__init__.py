"""The detector of ChArUco boards: markers first, then the corners between them."""
