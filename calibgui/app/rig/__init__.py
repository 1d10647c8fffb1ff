"""Rigs from photographs: which belongs to which camera and instant, each camera alone, and all."""
