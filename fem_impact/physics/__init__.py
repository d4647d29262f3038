"""Closed forms of contact, beam, heat and hardening."""
