"""The command line: scripts/velour VERB ... (docs/command_line.md). One module per verb."""
