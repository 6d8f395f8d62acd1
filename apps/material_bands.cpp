// zonal material: filled by the change that follows.
