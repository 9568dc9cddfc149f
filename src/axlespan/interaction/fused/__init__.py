"""The direct method for many steps at once in one compiled loop, where bands are narrow."""
