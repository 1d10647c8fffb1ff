"""The detectors of boards with AprilTags: AprilGrids, and checkerboards with tags in squares."""
