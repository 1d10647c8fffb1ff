"""The command line and the window share this, free of Qt: it searches, solves and writes."""
