"""What is on the pictures of an archive: all is read from it, nothing is computed again."""
