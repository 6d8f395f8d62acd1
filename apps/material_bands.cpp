// Under way: `zonal material` on top of projector and database.
