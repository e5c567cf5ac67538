"""What every other room needs: arrays, values, progress, threads."""
