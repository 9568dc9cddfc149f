"""The verification book: cases with known answers, and what axlespan gives."""
