"""Jobs of the commands: one job for each input, with its output, the processes that run it, and the report."""
