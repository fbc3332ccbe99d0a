"""Statistics of tables of lives: resampling, survival, effects, claims, factors."""
