"""What the program says while it works and when it ends."""
