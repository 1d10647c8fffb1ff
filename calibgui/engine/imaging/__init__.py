"""Images and the camera: maps, undistortion, rectification, rendering."""
