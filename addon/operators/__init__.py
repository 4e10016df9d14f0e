"""What the user can do: each operator checks, calls the bridge and reports."""
