"""Contact between wheels and running lines: motion along the line and contact rows."""
