"""What vertices, corners and faces carry beside positions: seams, and integers on both sides of them."""
