"""The window as a whole: menus, docks, the welcome page, the banner, the status bar."""
