"""How a process begins, and ends where it is asked to stop; and the job of several ranks."""
