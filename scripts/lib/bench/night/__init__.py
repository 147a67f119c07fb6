"""What scripts/night does to a farm of Slurm, and how it judges the images that come out."""
