"""Stage II: from a start to the camera and poses of least cost, and their covariances."""
