"""One hanging sheet, simulated by several programs: each measured in a process of its own."""
