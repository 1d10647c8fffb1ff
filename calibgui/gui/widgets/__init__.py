"""Small widgets and the theme, shared by several places on the screen."""
