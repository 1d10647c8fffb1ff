"""The command line: one module per subcommand, over the same actions as the window."""
