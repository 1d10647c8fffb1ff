"""The command line: one module per subcommand, with the same actions as the window."""
