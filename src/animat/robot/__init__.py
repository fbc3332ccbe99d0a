"""The Khepera: geometry, infrared sensors, motion and collision."""
