"""The command line: scripts/velour VERB ... (docs/reference/command_line.md). One module per verb."""
