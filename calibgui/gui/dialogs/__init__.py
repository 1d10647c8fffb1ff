"""Dialogs that open over the window: files, export, printing, help and failures."""
