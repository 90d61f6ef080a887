"""What is made of results: in Python, as a page, as figures, for ParaView."""
