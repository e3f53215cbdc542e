"""Wishes of users, and streams that keep them."""
