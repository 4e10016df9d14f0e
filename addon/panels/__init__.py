"""What the user sees in the Physics tab; panels only lay out."""
