"""What the pages of the verification share."""
