"""Where a solid yields under a punch or a pressure, and how much that carries until it does."""
